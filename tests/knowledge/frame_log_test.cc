#include "knowledge/frame_log.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "knowledge/sqlite.h"
#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

bool mentions(const Error& error, const std::string& words) {
  return error.message.find(words) != std::string::npos;
}

TEST_F(FrameLogTest, KeepsWhatWasCommittedAcrossReopening) {
  {
    auto log = open();
    EXPECT_EQ(log->last_sequence(), 0);
    EXPECT_TRUE(all(*log).empty());
    for (int n = 1; n <= 5; ++n) ASSERT_TRUE(log->append(frame_number(n)).ok());
    ASSERT_TRUE(log->commit().ok());
    ASSERT_TRUE(log->append(frame_number(6)).ok());  // goes with the log: never committed
    EXPECT_EQ(log->last_sequence(), 6);
  }
  auto log = open();
  EXPECT_EQ(log->last_sequence(), 5);
  const auto frames = all(*log);
  ASSERT_EQ(frames.size(), 5u);
  for (int n = 1; n <= 5; ++n) EXPECT_EQ(frames[n - 1], frame_number(n));
}

TEST_F(FrameLogTest, ReadsFromASequenceOnAndStopsWhenTold) {
  auto log = open();
  for (int n = 1; n <= 5; ++n) ASSERT_TRUE(log->append(frame_number(n)).ok());
  ASSERT_TRUE(log->commit().ok());
  const auto tail = all(*log, 3);
  ASSERT_EQ(tail.size(), 3u);
  EXPECT_EQ(tail.front().sequence, 3);
  int seen = 0;
  ASSERT_TRUE(log->for_each(1, [&](const LoggedFrame&) { return ++seen < 2; }).ok());
  EXPECT_EQ(seen, 2);
  EXPECT_EQ(all(*log).size(), 5u) << "a read that was stopped leaves nothing behind";
}

TEST_F(FrameLogTest, RollbackDropsTheBatchAndNothingElse) {
  auto log = open();
  ASSERT_TRUE(log->append(frame_number(1)).ok());
  ASSERT_TRUE(log->commit().ok());
  ASSERT_TRUE(log->append(frame_number(2)).ok());
  ASSERT_TRUE(log->append(frame_number(3)).ok());
  log->rollback();
  EXPECT_EQ(log->last_sequence(), 1);
  EXPECT_EQ(all(*log).size(), 1u);
  ASSERT_TRUE(log->append(frame_number(2)).ok());
  ASSERT_TRUE(log->commit().ok());
  ASSERT_TRUE(log->commit().ok()) << "without a batch there is nothing to do";
  log->rollback();
  EXPECT_EQ(all(*log).size(), 2u);
}

TEST_F(FrameLogTest, TellsRepeatedFramesFromChangedOnes) {
  auto log = open();
  const auto frame = frame_number(1);
  auto presence = [&](const std::string& robot, Utime utime, std::vector<std::uint8_t> bytes) {
    auto found = log->contains(robot, "laser", utime, bytes);
    EXPECT_TRUE(found.ok());
    return found.ok() ? *found : FrameLog::Presence::kNo;
  };
  EXPECT_EQ(presence("amigo", frame.utime, frame.bytes), FrameLog::Presence::kNo);
  ASSERT_TRUE(log->append(frame).ok());
  for (const bool committed : {false, true}) {
    if (committed) {
      ASSERT_TRUE(log->commit().ok());
    }
    EXPECT_EQ(presence("amigo", frame.utime, frame.bytes), FrameLog::Presence::kSame);
    EXPECT_EQ(presence("amigo", frame.utime, {}), FrameLog::Presence::kDifferent);
    auto changed = frame.bytes;
    changed.at(0) ^= 1;
    EXPECT_EQ(presence("amigo", frame.utime, changed), FrameLog::Presence::kDifferent);
    EXPECT_EQ(presence("", frame.utime, frame.bytes), FrameLog::Presence::kNo);
    EXPECT_EQ(presence("amigo", frame.utime + 1, frame.bytes), FrameLog::Presence::kNo);
  }
}

TEST_F(FrameLogTest, KeepsEmptyNamesAndEmptyBytes) {
  auto log = open();
  const LoggedFrame bare{LoggedFrame::Kind::kFrame, 1, kStart, "", "s", {}};
  ASSERT_TRUE(log->append(bare).ok());
  ASSERT_TRUE(log->commit().ok());
  EXPECT_EQ(all(*log), std::vector<LoggedFrame>{bare});
  auto found = log->contains("", "s", kStart, {});
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(*found, FrameLog::Presence::kSame);
}

TEST_F(FrameLogTest, RefusesASequenceOrATimeTwiceAndKeepsTheBatch) {
  auto log = open();
  ASSERT_TRUE(log->append(frame_number(1)).ok());
  for (const std::int64_t sequence : {3, 1, 0}) {
    auto again = frame_number(2);
    again.sequence = sequence;
    auto refused = log->append(again);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
    EXPECT_EQ(refused.error().field, "sequence");
  }
  auto same_time = frame_number(1);
  same_time.sequence = 2;
  auto refused = log->append(same_time);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
  EXPECT_EQ(refused.error().field, "utime");
  ASSERT_TRUE(log->append(frame_number(2)).ok());
  ASSERT_TRUE(log->commit().ok());
  EXPECT_EQ(all(*log).size(), 2u);
}

TEST_F(FrameLogTest, RefusesToShareADirectory) {
  auto log = open();
  const auto error = refusal();
  EXPECT_EQ(error.code, ErrorCode::kUnavailable);
  EXPECT_TRUE(mentions(error, directory_)) << error.message;
  EXPECT_TRUE(mentions(error, std::to_string(getpid()))) << error.message;
  ASSERT_TRUE(log->append(frame_number(1)).ok());
  ASSERT_TRUE(log->commit().ok());
  log.reset();
  EXPECT_EQ(all(*open()).size(), 1u);
}

TEST_F(FrameLogTest, LetsOthersReadMeanwhile) {
  auto log = open();
  ASSERT_TRUE(log->append(frame_number(1)).ok());
  ASSERT_TRUE(log->commit().ok());
  ASSERT_TRUE(log->append(frame_number(2)).ok());
  auto database = sqlite::Database::open(directory_ + "/anchord.db");
  ASSERT_TRUE(database.ok());
  auto count = database->read_integer("SELECT count(*) FROM frames");
  ASSERT_TRUE(count.ok()) << count.error().message;
  EXPECT_EQ(*count, 1);
  EXPECT_TRUE(log->commit().ok());
}

TEST_F(FrameLogTest, RefusesANewerVersion) {
  open();
  tamper("PRAGMA user_version=7");
  const auto error = refusal();
  EXPECT_EQ(error.code, ErrorCode::kConflict);
  EXPECT_TRUE(mentions(error, "version 7")) << error.message;
  EXPECT_TRUE(mentions(error, "up to " + std::to_string(FrameLog::kVersion))) << error.message;
}

TEST_F(FrameLogTest, RefusesTheDatabaseOfAnotherProgram) {
  std::filesystem::create_directory(directory_);
  tamper("CREATE TABLE recipes (name TEXT)");
  EXPECT_TRUE(mentions(refusal(), "another program"));
  tamper("DROP TABLE recipes; PRAGMA application_id=42");
  EXPECT_TRUE(mentions(refusal(), "another program"));
  tamper("PRAGMA application_id=0; PRAGMA user_version=1");
  EXPECT_TRUE(mentions(refusal(), "another program"));
}

TEST_F(FrameLogTest, RefusesAFileThatIsNoDatabaseAndLeavesItAlone) {
  std::filesystem::create_directory(directory_);
  const std::string text(2000, 'x');
  std::ofstream(directory_ + "/anchord.db") << text;
  EXPECT_TRUE(mentions(refusal(), "is no SQLite database"));
  std::ifstream file(directory_ + "/anchord.db");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
}

// Permission bits do not stop root, who may run this: these places refuse root as well.
TEST_F(FrameLogTest, RefusesADirectoryThatCannotBeWritten) {
  std::ofstream(root_ + "/file") << "x";
  for (const std::string& place :
       {root_ + "/file", root_ + "/file/data", std::string("/proc/data"), std::string("/proc")}) {
    auto log = FrameLog::open(place);
    ASSERT_FALSE(log.ok()) << place;
    EXPECT_EQ(log.error().code, ErrorCode::kIo);
    EXPECT_TRUE(mentions(log.error(), place)) << log.error().message;
    EXPECT_TRUE(mentions(log.error(), "--data")) << log.error().message;
  }
}

TEST_F(FrameLogTest, AFullDatabaseLosesTheBatchOnly) {
  auto log = open(200'000);
  std::int64_t next = 1;
  while (next <= 100) ASSERT_TRUE(log->append(frame_number(next++)).ok());
  ASSERT_TRUE(log->commit().ok());
  Status status = Done{};
  while (status.ok() && next < 10'000) status = log->append(frame_number(next++));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kStorage);
  EXPECT_TRUE(mentions(status.error(), "full")) << status.error().message;
  // Whether or not SQLite has ended the transaction, the batch is not taken up in its middle.
  EXPECT_FALSE(log->append(frame_number(next)).ok());
  EXPECT_FALSE(log->commit().ok());
  log->rollback();
  EXPECT_EQ(log->last_sequence(), 100);
  ASSERT_TRUE(log->append(frame_number(101)).ok());
  ASSERT_TRUE(log->commit().ok());
  log.reset();
  EXPECT_EQ(all(*open()).size(), 101u);
}

// The operating system itself refuses to write on: in a child, for the limit is the process's.
TEST_F(FrameLogTest, AFailingWriteLosesTheBatchOnly) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    auto log = FrameLog::open(directory_);
    if (!log) _exit(10);
    if (!(*log)->append(frame_number(1)).ok() || !(*log)->commit().ok()) _exit(11);
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    const auto before = limit.rlim_cur;
    limit.rlim_cur = 100'000;
    setrlimit(RLIMIT_FSIZE, &limit);
    Status status = Done{};
    std::int64_t next = 2;
    while (status.ok() && next < 5000) {
      status = (*log)->append(frame_number(next++));
      if (status.ok() && next % 10 == 0) status = (*log)->commit();
    }
    if (status.ok() || status.error().code != ErrorCode::kStorage) _exit(12);
    limit.rlim_cur = before;
    setrlimit(RLIMIT_FSIZE, &limit);
    (*log)->rollback();
    const auto last = (*log)->last_sequence();
    if (!(*log)->append(frame_number(last + 1)).ok() || !(*log)->commit().ok()) _exit(13);
    std::int64_t count = 0;
    auto read = (*log)->for_each(
        1, [&](const LoggedFrame& frame) { return frame == frame_number(++count); });
    _exit(read.ok() && count == last + 1 ? 0 : 14);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// Appends batches for ever and writes the last sequence to `acknowledge` after each commit.
[[noreturn]] void append_until_killed(const std::string& directory, int acknowledge) {
  auto log = FrameLog::open(directory);
  if (!log) _exit(10);
  for (std::int64_t next = (*log)->last_sequence() + 1;;) {
    for (std::int64_t i = 0; i <= next % 20; ++i)
      if (!(*log)->append(frame_number(next++)).ok()) _exit(11);
    if (!(*log)->commit().ok()) _exit(12);
    const std::int64_t last = next - 1;
    if (write(acknowledge, &last, sizeof last) != sizeof last) _exit(13);
  }
}

TEST_F(FrameLogTest, NothingAcknowledgedIsLostByAKill) {
  std::mt19937 random(1);  // any seed: it spreads the moments of the kills
  std::int64_t acknowledged = 0;
  for (int round = 0; round < 20; ++round) {
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) append_until_killed(directory_, pipe_ends[1]);
    close(pipe_ends[1]);
    const int batches = 1 + static_cast<int>(random() % 30);
    std::int64_t last = 0;
    for (int i = 0; i < batches; ++i) {
      ASSERT_EQ(read(pipe_ends[0], &last, sizeof last), static_cast<ssize_t>(sizeof last));
      acknowledged = last;
    }
    usleep(static_cast<useconds_t>(random() % 3000));  // somewhere within the next batches
    ASSERT_EQ(kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself: " << WEXITSTATUS(status);
    while (read(pipe_ends[0], &last, sizeof last) == static_cast<ssize_t>(sizeof last))
      acknowledged = last;
    close(pipe_ends[0]);

    auto log = open();
    ASSERT_GE(log->last_sequence(), acknowledged);
    std::int64_t count = 0;
    ASSERT_TRUE(
        log->for_each(1, [&](const LoggedFrame& frame) { return frame == frame_number(++count); })
            .ok());
    ASSERT_EQ(count, log->last_sequence()) << "in round " << round;
  }
}

}  // namespace
}  // namespace anchord
