// What a log holds beside frames, and reading it beside its writer.

#include "knowledge/log_reader.h"

#include <gtest/gtest.h>

#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

constexpr Utime kSecond = 1'000'000;

class LogReaderTest : public FrameLogTest {
 protected:
  LogReader reader() {
    auto reader = LogReader::open(directory_);
    EXPECT_TRUE(reader.ok());
    return *std::move(reader);
  }
  static void append(FrameLog& log, std::int64_t from, std::int64_t to) {
    for (std::int64_t n = from; n <= to; ++n) ASSERT_TRUE(log.append(frame_number(n)).ok());
    ASSERT_TRUE(log.commit().ok());
  }
  static std::vector<std::int64_t> sequences(LogReader& reader, std::int64_t from) {
    std::vector<std::int64_t> out;
    const Status read = reader.for_each(from, [&](const LoggedFrame& frame) {
      out.push_back(frame.sequence);
      return true;
    });
    EXPECT_TRUE(read.ok());
    return out;
  }
};

TEST_F(LogReaderTest, SeesWhatIsCommittedAndHoldsNothing) {
  auto log = open();
  append(*log, 1, 1000);  // several chunks
  auto beside = reader();
  ASSERT_TRUE(log->append(frame_number(1001)).ok());
  EXPECT_EQ(*beside.last_sequence(), 1000);
  EXPECT_EQ(sequences(beside, 1).size(), 1000u);
  EXPECT_EQ(sequences(beside, 700).front(), 700);
  ASSERT_TRUE(log->commit().ok());
  EXPECT_EQ(*beside.last_sequence(), 1001);
  EXPECT_EQ((*beside.at(1001))->utime, frame_number(1001).utime);
  EXPECT_FALSE(beside.at(1002)->has_value());
  ASSERT_EQ(beside.frames_at(frame_number(5).utime)->size(), 1u);
  EXPECT_EQ(beside.frames_at(frame_number(5).utime)->front(), frame_number(5));
  // In the middle of a read the writer may empty its WAL.
  const Status read = beside.for_each(1, [&](const LoggedFrame& frame) {
    if (frame.sequence == 1) append(*log, 1002, 1010);
    return true;
  });
  EXPECT_TRUE(read.ok());
}

TEST_F(LogReaderTest, TellsWhereThereIsNoLog) {
  const auto reader = LogReader::open(directory_);
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code, ErrorCode::kUnknown);
}

TEST_F(LogReaderTest, ConfigurationsStandFromTheirFirstFrameOn) {
  auto log = open();
  ASSERT_TRUE(log->put_configuration({1, "{one}"}).ok());
  append(*log, 1, 3);
  ASSERT_TRUE(log->put_configuration({4, "{two}"}).ok());
  log->rollback();
  auto beside = reader();
  EXPECT_EQ(beside.configurations()->size(), 1u) << "it goes with its batch";
  ASSERT_TRUE(log->put_configuration({4, "{two}"}).ok());
  append(*log, 4, 4);
  EXPECT_EQ(*beside.configurations(),
            (std::vector<LoggedConfiguration>{{1, "{one}"}, {4, "{two}"}}));
  tamper("UPDATE configurations SET text = '{three}' WHERE first = 4");
  EXPECT_EQ(beside.configurations().error().code, ErrorCode::kConflict);
}

TEST_F(LogReaderTest, WhatABaseStandsForCanBeDropped) {
  const LogBase base{{40, 7, 9, {1, 2, 3}, frame_number(40).utime}, 38};
  {
    auto log = open();
    append(*log, 1, 100);
    EXPECT_EQ(*log->drop(10), 0) << "nothing stands for it";
    ASSERT_TRUE(log->put_base(base).ok());
    EXPECT_EQ(*log->drop(30), 30);
    log->rollback();
    EXPECT_EQ(log->first_sequence(), 1);
    ASSERT_TRUE(log->put_base(base).ok());
    EXPECT_EQ(*log->drop(30), 30);
    ASSERT_TRUE(log->commit().ok());
    EXPECT_EQ(*log->drop(30), 7);
    EXPECT_EQ(*log->drop(30), 0);
    ASSERT_TRUE(log->commit().ok());
    EXPECT_GT(log->size()->free, 0);
  }
  auto log = open();
  EXPECT_EQ(log->first_sequence(), 38);
  EXPECT_EQ(log->last_sequence(), 100);
  EXPECT_EQ(all(*log, 38).size(), 63u);
  EXPECT_FALSE(log->for_each(37, [](const auto&) { return true; }).ok());
  auto beside = reader();
  const auto kept = beside.base();
  ASSERT_TRUE(kept.ok() && kept->has_value());
  EXPECT_EQ((*kept)->checkpoint, base.checkpoint);
  EXPECT_EQ((*kept)->first_kept, 38);
  tamper("UPDATE base SET bytes = x'010204'");
  EXPECT_EQ(beside.base().error().code, ErrorCode::kConflict);
}

TEST_F(LogReaderTest, TheLastFrameIsNeverDropped) {
  {
    auto log = open();
    append(*log, 1, 5);
    ASSERT_TRUE(log->put_base({{5, 7, 9, {1}, 5}, 6}).ok());
    EXPECT_EQ(*log->drop(100), 4);
    ASSERT_TRUE(log->commit().ok());
  }
  EXPECT_EQ(open()->last_sequence(), 5) << "no less than was acknowledged";
}

HistorySample sample(int second, const std::string& place = "kitchen") {
  return {"cup-1", kStart + second * kSecond, 0.5, place, {1, 2, 0.125}, 0.25};
}

TEST_F(LogReaderTest, KeepsHistories) {
  auto log = open();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(log->put_sample(sample(i)).ok());
  HistorySample other = sample(3, "");
  other.object = "cup-2";
  ASSERT_TRUE(log->put_sample(other).ok());
  ASSERT_TRUE(log->put_sample(sample(4, "hall")).ok());  // in the place of the first
  append(*log, 1, 1);
  auto beside = reader();
  const auto some = beside.history({"cup-1", kStart + 3 * kSecond, kStart + 5 * kSecond});
  EXPECT_EQ(*some, (std::vector<HistorySample>{sample(3), sample(4, "hall"), sample(5)}));
  EXPECT_EQ(*beside.last_sample("cup-1"), sample(9));
  EXPECT_EQ(*beside.history({"cup-2"}), std::vector<HistorySample>{other});
  EXPECT_FALSE(beside.last_sample("cup-3")->has_value());
  EXPECT_EQ(beside.history({"cup-1", 0, kLatestUtime, 3})->size(), 4u)
      << "three of them evenly, and where the place changes";
}

TEST_F(LogReaderTest, ThinsHistoriesButNotChangesOfPlace) {
  auto log = open();
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(log->put_sample(sample(i, i == 55 ? "hall" : "kitchen")).ok());
  const Utime until = kStart + 90 * kSecond;
  std::int64_t gone = 0, steps = 0;
  for (std::int64_t last = 1; last > 0 || steps < 8; ++steps)
    gone += last = *log->thin_history(10, until, 20);  // a few rows at a time
  append(*log, 1, 1);
  auto beside = reader();
  const auto kept = *beside.history({"cup-1"});
  EXPECT_EQ(kept.size(), 100u - gone);
  std::vector<int> seconds;
  for (const auto& one : kept)
    if (one.utime < until) seconds.push_back(static_cast<int>((one.utime - kStart) / kSecond));
  EXPECT_EQ(seconds, (std::vector<int>{0, 10, 20, 30, 40, 50, 55, 56, 60, 70, 80}));
  EXPECT_EQ(kept.size() - seconds.size(), 10u) << "what is not that old";
}

}  // namespace
}  // namespace anchord
