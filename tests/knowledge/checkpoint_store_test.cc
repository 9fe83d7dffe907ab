#include "knowledge/checkpoint_store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();

using CheckpointStoreTest = FrameLogTest;

StoredCheckpoint checkpoint(std::int64_t sequence) {
  return {sequence, 11, 7, std::vector<std::uint8_t>(5000, sequence % 256), 1000 + sequence};
}

TEST_F(CheckpointStoreTest, GivesTheNewest) {
  {
    auto store = CheckpointStore::open(root_);
    ASSERT_TRUE(store.ok());
    EXPECT_FALSE((*store->newest(kAny)).has_value());
    for (const std::int64_t sequence : {10, 20, 30})
      ASSERT_TRUE(store->put(checkpoint(sequence)).ok());
  }
  auto store = CheckpointStore::open(root_);
  const auto newest = *store->newest(kAny);
  ASSERT_TRUE(newest.has_value());
  EXPECT_EQ(newest->sequence, 30);
  EXPECT_EQ(newest->frame_checksum, 11u);
  EXPECT_EQ(newest->bytes, checkpoint(30).bytes);
  EXPECT_EQ((*store->newest(30))->sequence, 20);
  EXPECT_FALSE((*store->newest(20)).has_value()) << "two are kept";
  EXPECT_EQ(newest->configuration, 7u);
}

TEST_F(CheckpointStoreTest, ForgetsThoseOfALogThatWasLonger) {
  auto store = CheckpointStore::open(root_);
  ASSERT_TRUE(store->put(checkpoint(100)).ok());
  ASSERT_TRUE(store->put(checkpoint(5)).ok());
  EXPECT_EQ((*store->newest(kAny))->sequence, 5);
}

TEST_F(CheckpointStoreTest, KeepsThoseOfThePast) {
  auto store = CheckpointStore::open(root_);
  EXPECT_EQ(*store->newest_past(), 0);
  for (std::int64_t sequence = 10; sequence <= 100; sequence += 10)
    ASSERT_TRUE(store->put(checkpoint(sequence), sequence % 30 == 0).ok());
  EXPECT_EQ(*store->newest_past(), 90);
  EXPECT_EQ((*store->newest_until(1099, kAny))->sequence, 90);
  EXPECT_EQ((*store->newest_until(1089, kAny))->sequence, 60);
  EXPECT_EQ((*store->newest_until(1089, 60))->sequence, 30);
  EXPECT_FALSE((*store->newest_until(1029, kAny)).has_value());
  EXPECT_EQ((*store->oldest_from(31))->sequence, 60);
  EXPECT_EQ(*store->bytes(), 4 * 5000) << "30, 60, and the newest two, of which one is of the past";
  ASSERT_TRUE(store->forget_before(60).ok());
  EXPECT_FALSE((*store->newest_until(1059, kAny)).has_value());
}

TEST_F(CheckpointStoreTest, TakesOverThoseOfVersion1) {
  {
    auto database = sqlite::Database::open(root_ + "/anchord.db-checkpoints");
    ASSERT_TRUE(database
                    ->execute("CREATE TABLE checkpoints (sequence INTEGER PRIMARY KEY, "
                              "frame_checksum INTEGER NOT NULL, configuration INTEGER NOT NULL, "
                              "checksum INTEGER NOT NULL, bytes BLOB NOT NULL) STRICT;"
                              "INSERT INTO checkpoints VALUES (5, 11, 7, " +
                              std::to_string(checksum(checkpoint(5))) +
                              ", zeroblob(5000));"
                              "PRAGMA user_version=1")
                    .ok());
    auto insert = sqlite::Statement::prepare(*database, "UPDATE checkpoints SET bytes = ?1");
    const auto bytes = checkpoint(5).bytes;
    ASSERT_TRUE(insert->bind(1, std::span<const std::uint8_t>(bytes)).step().ok());
  }
  auto store = CheckpointStore::open(root_);
  const auto kept = *store->newest(kAny);
  ASSERT_TRUE(kept.has_value());
  EXPECT_EQ(kept->bytes, checkpoint(5).bytes);
  EXPECT_EQ(kept->utime, 0);
  EXPECT_FALSE((*store->newest_until(kAny, kAny)).has_value()) << "its time is not known";
}

TEST_F(CheckpointStoreTest, ADamagedOneIsPassedOver) {
  auto store = CheckpointStore::open(root_);
  for (const std::int64_t sequence : {1, 2}) ASSERT_TRUE(store->put(checkpoint(sequence)).ok());
  auto database = sqlite::Database::open(root_ + "/anchord.db-checkpoints");
  ASSERT_TRUE(
      database->execute("UPDATE checkpoints SET bytes = zeroblob(5000) WHERE sequence = 2").ok());
  EXPECT_EQ((*store->newest(kAny))->sequence, 1);
}

TEST_F(CheckpointStoreTest, AFileThatIsNoDatabaseIsMadeAnew) {
  std::ofstream(root_ + "/anchord.db-checkpoints") << std::string(8192, 'x');
  auto store = CheckpointStore::open(root_);
  ASSERT_TRUE(store.ok());
  EXPECT_TRUE(store->put(checkpoint(1)).ok());
}

}  // namespace
}  // namespace anchord
