// What stands in the log beside frames: events and tasks; and how older logs come to have room for
// them.

#include <map>
#include <span>

#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

TEST_F(FrameLogTest, EventsStandAmongTheFramesAndMayShareATime) {
  const LoggedFrame frame = frame_number(1);
  LoggedFrame event = frame;
  event.kind = LoggedFrame::Kind::kEvent;
  event.sequence = 2;
  LoggedFrame other = event;
  other.sequence = 3;
  other.bytes.push_back(1);
  {
    auto log = open();
    for (const LoggedFrame& one : {frame, event, other}) ASSERT_TRUE(log->append(one).ok());
    ASSERT_TRUE(log->commit().ok());
  }
  auto log = open();
  EXPECT_EQ(all(*log), (std::vector<LoggedFrame>{frame, event, other}));
  EXPECT_TRUE(*log->contains_event(event.utime, event.bytes));
  EXPECT_TRUE(*log->contains_event(event.utime, other.bytes));
  EXPECT_FALSE(*log->contains_event(event.utime + 1, event.bytes));
  // The other event's bytes are no frame's.
  EXPECT_EQ(*log->contains(frame.robot, frame.sensor, frame.utime, other.bytes),
            FrameLog::Presence::kDifferent);
}

TEST_F(FrameLogTest, KeepsTheNewestRecordOfEachTask) {
  using Tasks = std::map<std::int64_t, std::vector<std::uint8_t>>;
  const auto tasks = [&](FrameLog& log) {
    Tasks out;
    EXPECT_TRUE(log.for_each_task([&](std::int64_t id, std::span<const std::uint8_t> bytes) {
                     out[id].assign(bytes.begin(), bytes.end());
                     return true;
                   })
                    .ok());
    return out;
  };
  {
    auto log = open();
    ASSERT_TRUE(log->put_task(1, true, {1}).ok());
    ASSERT_TRUE(log->put_task(2, true, {2}).ok());
    ASSERT_TRUE(log->put_task(1, true, {1, 1}).ok());
    ASSERT_TRUE(log->commit().ok());
    ASSERT_TRUE(log->put_task(3, true, {3}).ok());
    log->rollback();
    ASSERT_TRUE(log->put_task(4, true, {4}).ok());  // not committed
  }
  auto log = open();
  EXPECT_EQ(tasks(*log), (Tasks{{1, {1, 1}}, {2, {2}}}));
  ASSERT_TRUE(log->put_task(5, true, {5}).ok());
  ASSERT_TRUE(log->put_task(6, false, {6}).ok());
  ASSERT_TRUE(log->keep_tasks(5).ok());  // 2 to 6
  ASSERT_TRUE(log->commit().ok());
  EXPECT_EQ(tasks(*log), (Tasks{{2, {2}}, {5, {5}}, {6, {6}}}));
  ASSERT_TRUE(log->put_task(9, true, {9}).ok());
  ASSERT_TRUE(log->keep_tasks(1).ok());  // 9, and 6, which has not ended
  ASSERT_TRUE(log->commit().ok());
  EXPECT_EQ(tasks(*log), (Tasks{{6, {6}}, {9, {9}}}));
}

TEST_F(FrameLogTest, KeepsTheBoundOnAFramesWork) {
  {
    auto log = open();
    for (int i = 1; i <= 2; ++i) {
      LoggedFrame frame = frame_number(i);
      if (i == 2) frame.work = 12'345;
      ASSERT_TRUE(log->append(frame).ok());
    }
    ASSERT_TRUE(log->commit().ok());
  }
  auto log = open();
  const auto frames = all(*log);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].work, std::nullopt);
  EXPECT_EQ(frames[1].work, 12'345);
}

/// Takes back what version 5 added.
const std::string kToVersion4 =
    "DROP INDEX frames_by_time; DROP TABLE configurations; DROP TABLE base; DROP TABLE history;"
    "DROP TABLE thinned;"
    "CREATE UNIQUE INDEX frames_by_sensor ON frames (robot, sensor, utime) WHERE kind = 0;";

TEST_F(FrameLogTest, BringsVersion4UpToDate) {
  {
    auto log = open();
    ASSERT_TRUE(log->append(frame_number(1)).ok());
    ASSERT_TRUE(log->commit().ok());
  }
  tamper(kToVersion4 + "PRAGMA user_version=4");
  auto log = open();
  ASSERT_TRUE(log->append(frame_number(2)).ok());
  EXPECT_EQ(all(*log), (std::vector<LoggedFrame>{frame_number(1), frame_number(2)}));
  EXPECT_TRUE(log->reader().configurations()->empty());
  LoggedFrame again = frame_number(3);
  again.utime = frame_number(1).utime;
  EXPECT_EQ(log->append(again).error().code, ErrorCode::kConflict);
}

TEST_F(FrameLogTest, BringsVersion3UpToDate) {
  {
    auto log = open();
    ASSERT_TRUE(log->append(frame_number(1)).ok());
    ASSERT_TRUE(log->commit().ok());
  }
  tamper(kToVersion4 + "ALTER TABLE frames DROP COLUMN checksum; PRAGMA user_version=3");
  auto log = open();
  ASSERT_TRUE(log->append(frame_number(2)).ok());
  EXPECT_EQ(all(*log), (std::vector<LoggedFrame>{frame_number(1), frame_number(2)}));
}

TEST_F(FrameLogTest, BringsVersion2UpToDate) {
  {
    auto log = open();
    ASSERT_TRUE(log->append(frame_number(1)).ok());
    ASSERT_TRUE(log->commit().ok());
  }
  tamper(kToVersion4 +
         "ALTER TABLE frames DROP COLUMN checksum; ALTER TABLE frames DROP COLUMN work;"
         "PRAGMA user_version=2");
  auto log = open();
  EXPECT_EQ(all(*log), std::vector<LoggedFrame>{frame_number(1)});
  LoggedFrame bounded = frame_number(2);
  bounded.work = 7;
  ASSERT_TRUE(log->append(bounded).ok());
  EXPECT_EQ(all(*log).back(), bounded);
}

TEST_F(FrameLogTest, BringsVersion1UpToDate) {
  {
    auto log = open();
    ASSERT_TRUE(log->append(frame_number(1)).ok());
    ASSERT_TRUE(log->commit().ok());
  }
  // As the first version made it.
  tamper(kToVersion4 +
         "DROP TABLE tasks; DROP INDEX events_by_time; DROP INDEX frames_by_sensor;"
         "ALTER TABLE frames DROP COLUMN kind; ALTER TABLE frames DROP COLUMN work;"
         "ALTER TABLE frames DROP COLUMN checksum;"
         "CREATE UNIQUE INDEX frames_by_sensor ON frames (robot, sensor, utime);"
         "PRAGMA user_version=1");
  for (int time = 0; time < 2; ++time) {
    auto log = open();
    EXPECT_EQ(all(*log), std::vector<LoggedFrame>{frame_number(1)});
    EXPECT_TRUE(log->put_task(1, true, {1}).ok());
    LoggedFrame event = frame_number(1);
    event.kind = LoggedFrame::Kind::kEvent;
    event.sequence = 2;
    EXPECT_TRUE(log->append(event).ok());  // not committed
  }
}

}  // namespace
}  // namespace anchord
