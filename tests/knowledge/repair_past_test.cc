// What a log holds of the past is saved, too: configurations, histories, and the base.

#include <gtest/gtest.h>

#include "knowledge/log_repair.h"
#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

constexpr std::int64_t kFrames = 100, kFirstKept = 38, kBase = 40, kChange = 60;

class RepairPastTest : public FrameLogTest {
 protected:
  /// A log whose beginning was given up, with a change of the configuration.
  void SetUp() override {
    FrameLogTest::SetUp();
    auto log = open();
    ASSERT_TRUE(log->put_configuration({1, "{one}"}).ok());
    for (std::int64_t n = 1; n < kChange; ++n) ASSERT_TRUE(log->append(frame_number(n)).ok());
    ASSERT_TRUE(log->put_configuration({kChange, "{two}"}).ok());
    for (std::int64_t n = kChange; n <= kFrames; ++n)
      ASSERT_TRUE(log->append(frame_number(n)).ok());
    for (const double x : {0.0, 1.0, 0.5})  // whole numbers are stored otherwise
      ASSERT_TRUE(
          log->put_sample(
                 {"cup-1", kStart + from_seconds(x), 1, x > 0 ? "hall" : "", {x, 2, 0.25}, x})
              .ok());
    ASSERT_TRUE(log->put_base(base()).ok());
    ASSERT_TRUE(log->drop(1000).ok());
    ASSERT_TRUE(log->commit().ok());
    history_ = *log->reader().history({"cup-1"});
  }
  static LogBase base() {
    return {{kBase, checksum(frame_number(kBase)), 9, {1, 2, 3}, frame_number(kBase).utime},
            kFirstKept};
  }
  RepairReport repaired(std::optional<Utime> until = {}) {
    const auto report = repair_log(directory_, {[](const LoggedFrame&) { return false; }, until});
    EXPECT_TRUE(report.ok());
    return report ? *report : RepairReport{};
  }

  std::vector<HistorySample> history_;
};

TEST_F(RepairPastTest, AllOfItIsThere) {
  const RepairReport report = repaired();
  EXPECT_EQ(report.saved, kFrames - kFirstKept + 1);
  EXPECT_TRUE(report.lost.empty());
  EXPECT_FALSE(report.base_lost);
  auto log = open();
  EXPECT_EQ(log->first_sequence(), kFirstKept);
  EXPECT_EQ(log->last_sequence(), kFrames);
  EXPECT_EQ(all(*log, kFirstKept).back(), frame_number(kFrames));
  EXPECT_EQ(history_.size(), 3u);
  EXPECT_EQ(*log->reader().history({"cup-1"}), history_);
  EXPECT_EQ((*log->reader().base())->checkpoint, base().checkpoint);
  EXPECT_EQ(*log->reader().configurations(),
            (std::vector<LoggedConfiguration>{{kFirstKept, "{one}"}, {kChange, "{two}"}}));
}

TEST_F(RepairPastTest, ALossShiftsWhatComesAfter) {
  tamper("DELETE FROM frames WHERE sequence = 50");
  const RepairReport report = repaired();
  EXPECT_EQ(report.lost, (std::vector<RepairReport::Range>{{50, 50}}));
  auto log = open();
  EXPECT_EQ(log->last_sequence(), kFrames - 1);
  EXPECT_EQ(log->reader().configurations()->back().first, kChange - 1);
}

TEST_F(RepairPastTest, WithoutItsFramesABaseIsLost) {
  for (const char* change :
       {"DELETE FROM frames WHERE sequence = 39", "UPDATE base SET bytes = x'00'"}) {
    SCOPED_TRACE(change);
    tamper(change);
    const RepairReport report = repaired();
    auto log = open();
    EXPECT_FALSE(log->reader().base()->has_value());
    EXPECT_EQ(log->first_sequence(), 1);
    EXPECT_FALSE(report.lost.empty());
    log.reset();
    std::filesystem::remove_all(directory_);
    SetUp();
  }
}

TEST_F(RepairPastTest, NothingGoesBackBeforeTheBase) {
  const auto report =
      repair_log(directory_, {[](const LoggedFrame&) { return false; }, frame_number(10).utime});
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().field, "--until");
}

}  // namespace
}  // namespace anchord
