#include "knowledge/checkpoint_store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();

using CheckpointStoreTest = FrameLogTest;

StoredCheckpoint checkpoint(std::int64_t sequence, std::uint64_t configuration = 7) {
  return {sequence, 11, configuration, std::vector<std::uint8_t>(5000, sequence % 256)};
}

TEST_F(CheckpointStoreTest, GivesTheNewestOfAConfiguration) {
  {
    auto store = CheckpointStore::open(root_);
    ASSERT_TRUE(store.ok());
    EXPECT_FALSE((*store->newest(7, kAny)).has_value());
    for (const std::int64_t sequence : {10, 20, 30})
      ASSERT_TRUE(store->put(checkpoint(sequence)).ok());
  }
  auto store = CheckpointStore::open(root_);
  const auto newest = *store->newest(7, kAny);
  ASSERT_TRUE(newest.has_value());
  EXPECT_EQ(newest->sequence, 30);
  EXPECT_EQ(newest->frame_checksum, 11u);
  EXPECT_EQ(newest->bytes, checkpoint(30).bytes);
  EXPECT_EQ((*store->newest(7, 30))->sequence, 20);
  EXPECT_FALSE((*store->newest(7, 20)).has_value()) << "two are kept";
  EXPECT_FALSE((*store->newest(8, kAny)).has_value());
}

TEST_F(CheckpointStoreTest, ForgetsThoseOfALogThatWasLonger) {
  auto store = CheckpointStore::open(root_);
  ASSERT_TRUE(store->put(checkpoint(100)).ok());
  ASSERT_TRUE(store->put(checkpoint(5)).ok());
  EXPECT_EQ((*store->newest(7, kAny))->sequence, 5);
}

TEST_F(CheckpointStoreTest, ADamagedOneIsPassedOver) {
  auto store = CheckpointStore::open(root_);
  for (const std::int64_t sequence : {1, 2}) ASSERT_TRUE(store->put(checkpoint(sequence)).ok());
  auto database = sqlite::Database::open(root_ + "/anchord.db-checkpoints");
  ASSERT_TRUE(
      database->execute("UPDATE checkpoints SET bytes = zeroblob(5000) WHERE sequence = 2").ok());
  EXPECT_EQ((*store->newest(7, kAny))->sequence, 1);
}

TEST_F(CheckpointStoreTest, AFileThatIsNoDatabaseIsMadeAnew) {
  std::ofstream(root_ + "/anchord.db-checkpoints") << std::string(8192, 'x');
  auto store = CheckpointStore::open(root_);
  ASSERT_TRUE(store.ok());
  EXPECT_TRUE(store->put(checkpoint(1)).ok());
}

}  // namespace
}  // namespace anchord
