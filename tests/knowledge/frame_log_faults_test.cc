// The log on a machine that fails: after a fault at any point, what was acknowledged is there.

#include <map>
#include <set>

#include "tests/knowledge/fault_vfs.h"
#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

using Fault = FaultVfs::Fault;

/// How much a run writes.
struct Load {
  int batches, frames;  ///< per life of the log, of which there are two; per batch
  std::size_t bytes;    ///< per frame
};
constexpr Load kSmall{4, 3, 300};
/// More than the thousand pages after which a commit moves the log's tail into the database.
constexpr Load kLarge{5, 3, 160'000};

/// A writer that meets faults as the daemon does: a batch that fails is rolled back, and other
/// frames come in its place.
class FaultyWriter {
 public:
  FaultyWriter(std::string directory, const Load& load)
      : directory_(std::move(directory)), load_(load) {}

  /// Two lives of the log. False: it gave up.
  bool run() {
    for (int life = 0; life < 2; ++life) {
      auto log = open();
      if (!log) return false;
      for (int batch = 0; batch < load_.batches; ++batch)
        if (!write(*log)) return false;
    }
    return true;
  }

  /// What the log holds now must be all that was acknowledged, and of the rest what was given.
  void expect_kept() {
    auto log = FrameLog::open(directory_);
    ASSERT_TRUE(log.ok()) << log.error().text();
    std::int64_t last = 0;
    const Status read = (*log)->for_each(1, [&](const LoggedFrame& frame) {
      EXPECT_EQ(frame.sequence, ++last);
      EXPECT_TRUE(last > acknowledged_ || frame.utime == kept_[last].utime)
          << "another frame than was acknowledged";
      EXPECT_TRUE(given_.contains(frame.utime));
      EXPECT_TRUE(frame == made(frame.sequence, frame.utime)) << frame.sequence;
      return true;
    });
    EXPECT_TRUE(read.ok()) << read.error().text();
    EXPECT_GE(last, acknowledged_);
    // It works on.
    for (std::int64_t more = 1; more <= 2; ++more)
      EXPECT_TRUE((*log)->append(made(last + more, ++utime_)).ok());
    EXPECT_TRUE((*log)->commit().ok());
  }

  std::int64_t acknowledged() const { return acknowledged_; }
  const std::set<std::string>& errors() const { return errors_; }

 private:
  LoggedFrame made(std::int64_t sequence, Utime utime) const {
    LoggedFrame frame{LoggedFrame::Kind::kFrame, sequence, utime, "amigo", "kinect", {}};
    // Another size for each: what comes in place of a failed batch is longer or shorter.
    frame.bytes.resize(load_.bytes + static_cast<std::size_t>(utime % 7 * 100));
    for (std::size_t i = 0; i < frame.bytes.size(); ++i)
      frame.bytes[i] = static_cast<std::uint8_t>(static_cast<std::size_t>(utime) * 31 + i);
    return frame;
  }
  std::unique_ptr<FrameLog> open() {
    for (int attempt = 0; attempt < 2; ++attempt) {
      auto log = FrameLog::open(directory_);
      if (log) return *std::move(log);
      errors_.insert(log.error().text());
    }
    return nullptr;
  }
  bool write(FrameLog& log) {
    for (int attempt = 0; attempt < 3; ++attempt) {
      std::vector<LoggedFrame> batch;
      Status done = Done{};
      for (int i = 0; i < load_.frames && done; ++i) {
        batch.push_back(made(acknowledged_ + i + 1, ++utime_));
        given_.insert(utime_);
        done = log.append(batch.back());
      }
      if (done) done = log.commit();
      if (done) {
        for (const LoggedFrame& frame : batch) kept_[frame.sequence] = frame;
        acknowledged_ += load_.frames;
        return true;
      }
      errors_.insert(done.error().text());
      log.rollback();
      EXPECT_EQ(log.last_sequence(), acknowledged_);
    }
    return false;
  }

  std::string directory_;
  Load load_;
  std::int64_t acknowledged_ = 0;
  Utime utime_ = kStart;
  std::set<Utime> given_;
  std::map<std::int64_t, LoggedFrame> kept_;
  std::set<std::string> errors_;
};

class FrameLogFaultsTest : public FrameLogTest {
 protected:
  /// How many operations a run takes.
  static std::int64_t operations(const std::string& directory, const Load& load) {
    FaultVfs disk;
    FaultyWriter writer(directory, load);
    EXPECT_TRUE(writer.run());
    EXPECT_EQ(writer.acknowledged(), 2 * load.batches * load.frames);
    EXPECT_TRUE(writer.errors().empty());
    return disk.operations();
  }
  /// A directory of its own for each run.
  std::string fresh() { return root_ + "/" + std::to_string(++runs_); }

  void fail_at(std::int64_t at, Fault fault, bool lasts, const Load& load) {
    FaultVfs disk;
    FaultyWriter writer(fresh(), load);
    disk.fail(at, fault, lasts);
    const bool went_on = writer.run();
    disk.heal();
    EXPECT_TRUE(went_on || lasts) << "one fault is no reason to give up";
    EXPECT_TRUE(went_on || !writer.errors().empty()) << "it gave up in silence";
    for (const std::string& error : writer.errors())
      EXPECT_TRUE(error.find("frame log") != std::string::npos ||
                  error.find("anchord.db") != std::string::npos)
          << "nobody could tell what failed: " << error;
    writer.expect_kept();
  }
  void fail_everywhere(const Load& load, std::int64_t stride) {
    const std::int64_t count = operations(fresh(), load);
    RecordProperty("operations", std::to_string(count));
    for (std::int64_t at = 1; at <= count && !HasFailure(); at += stride)
      for (const Fault fault : {Fault::kIo, Fault::kNoSpace})
        for (const bool lasts : {false, true}) {
          SCOPED_TRACE(testing::Message() << "operation " << at << " of " << count
                                          << (fault == Fault::kIo ? ", I/O error" : ", disk full")
                                          << (lasts ? ", from then on" : ", once"));
          fail_at(at, fault, lasts, load);
        }
  }
  void lose_power_everywhere(const Load& load, std::int64_t stride, std::uint32_t seeds) {
    const std::int64_t count = operations(fresh(), load);
    RecordProperty("operations", std::to_string(count));
    for (std::int64_t at = 1; at <= count && !HasFailure(); at += stride)
      for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        SCOPED_TRACE(testing::Message()
                     << "power lost at operation " << at << " of " << count << ", seed " << seed);
        FaultVfs disk;
        FaultyWriter writer(fresh(), load);
        disk.fail(at, Fault::kIo, true);  // what is done after the end is not done
        writer.run();
        disk.heal();
        disk.lose_power(seed);
        writer.expect_kept();
      }
  }

  void TearDown() override {
    RecordProperty("runs", runs_);
    FrameLogTest::TearDown();
  }

 private:
  int runs_ = 0;
};

TEST_F(FrameLogFaultsTest, EveryOperationFails) { fail_everywhere(kSmall, 1); }

// Primes, so that all of what repeats is met.
TEST_F(FrameLogFaultsTest, OperationsFailWhileTheLogMovesIntoTheDatabase) {
  fail_everywhere(kLarge, 97);
}

TEST_F(FrameLogFaultsTest, PowerIsLostAtEveryOperation) { lose_power_everywhere(kSmall, 1, 8); }

TEST_F(FrameLogFaultsTest, PowerIsLostWhileTheLogMovesIntoTheDatabase) {
  lose_power_everywhere(kLarge, 53, 3);
}

// The seam itself: without the sync that a commit waits for, something is lost.
TEST_F(FrameLogFaultsTest, WhatIsNotSyncedIsLost) {
  int lost = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    FaultVfs disk;
    const std::string path = root_ + "/unsynced.db";
    {
      auto database = sqlite::Database::open(path);
      ASSERT_TRUE(database.ok());
      ASSERT_TRUE(database->read_text("PRAGMA journal_mode=WAL").ok());
      ASSERT_TRUE(database->execute("PRAGMA synchronous=OFF; CREATE TABLE t (x)").ok());
      disk.fail(1, Fault::kIo, true);
    }
    disk.heal();
    disk.lose_power(seed);
    auto database = sqlite::Database::open(path);
    ASSERT_TRUE(database.ok());
    const auto count = database->read_integer("SELECT count(*) FROM t");
    lost += count.ok() ? 0 : 1;
  }
  EXPECT_GT(lost, 0);
}

}  // namespace
}  // namespace anchord
