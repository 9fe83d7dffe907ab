// Clocks that jump: a frame from the future does not shut out the present.

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <future>
#include <sstream>

#include "daemon/journal.h"
#include "tests/daemon/scene.h"

namespace anchord {
namespace {

constexpr Utime kSecond = 1'000'000, kDay = 86'400 * kSecond, kYear = 365 * kDay;

class ClockTest : public ::testing::Test {
 protected:
  void start() {
    journal_.reset();
    auto log = FrameLog::open(folder_ / "data");
    ASSERT_TRUE(log.ok());
    Journal::Hooks hooks;
    hooks.now = [this] { return clock_.load(); };
    journal_ = std::make_unique<Journal>(World(scene()), *std::move(log), statistics_, times_,
                                         std::move(hooks));
    ASSERT_TRUE(journal_->restore(std::atomic<bool>{false}).ok());
    journal_->start();
  }
  Result<Receipt> send_at(Utime utime) {
    Frame frame = frame_number(0);
    frame.utime = utime;
    std::promise<Result<Receipt>> promise;
    EXPECT_TRUE(journal_->submit(
        {{frame}, "test", false, [&](Result<Receipt> r) { promise.set_value(std::move(r)); }}));
    return promise.get_future().get();
  }
  void expect_refused(Utime utime, const std::string& words) {
    const auto belief = journal_->snapshot().belief;
    const auto refused = send_at(utime);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
    EXPECT_EQ(refused.error().field, "utime");
    EXPECT_NE(refused.error().message.find(words), std::string::npos) << refused.error().message;
    EXPECT_EQ(journal_->snapshot().belief, belief);
  }

  TestFolder folder_;
  Statistics statistics_;
  UpdateTimes times_;
  std::atomic<Utime> clock_{kStart};
  std::unique_ptr<Journal> journal_;
};

TEST_F(ClockTest, ASensorThatLeapsAheadIsRefusedAndOthersGoOn) {
  start();
  ASSERT_TRUE(send_at(kStart).ok());
  expect_refused(kStart + kYear, "31536000 s ahead");
  EXPECT_TRUE(send_at(kStart + kSecond).ok()) << "the present goes on";
  EXPECT_EQ(statistics_.ahead, 1u);
  EXPECT_EQ(statistics_.refused, 1u);
  EXPECT_EQ(send_at(kStart + 200 * kYear).error().code, ErrorCode::kInvalid) << "no time at all";
  // world.max_leap is 600 s, from the newest frame.
  EXPECT_TRUE(send_at(kStart + 601 * kSecond).ok());
  expect_refused(kStart + 1202 * kSecond, "601 s ahead");
  EXPECT_EQ(statistics_.ahead, 2u);
}

TEST_F(ClockTest, AfterAMonthInTheCupboardTheClockVouches) {
  start();
  ASSERT_TRUE(send_at(kStart).ok());
  clock_ = kStart + 30 * kDay;
  EXPECT_TRUE(send_at(kStart + 30 * kDay).ok());
}

TEST_F(ClockTest, RecordingsOfAnyTimeCanBePlayed) {
  start();
  const Utime future = kStart + 50 * kYear;
  ASSERT_TRUE(send_at(future).ok()) << "the first frame says what time it is";
  EXPECT_TRUE(send_at(future + 100 * kSecond).ok());
  EXPECT_EQ(statistics_.ahead, 0u);
  start();
  EXPECT_TRUE(send_at(future + 200 * kSecond).ok()) << "and goes on after a restart";
}

TEST_F(ClockTest, WhereTheClockItselfLeaptThePresentIsRefusedAloud) {
  start();
  ASSERT_TRUE(send_at(kStart).ok());
  clock_ = kStart + kYear;
  ASSERT_TRUE(send_at(kStart + kYear).ok());
  clock_ = kStart + 2 * kSecond;
  std::ostringstream log;
  const auto before = spdlog::default_logger();
  const auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(log);
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
  expect_refused(kStart + 2 * kSecond, "not after this sensor's last frame");
  expect_refused(kStart + 3 * kSecond, "not after this sensor's last frame");
  journal_.reset();
  spdlog::set_default_logger(before);
  const std::string told = log.str();
  const auto at = told.find("anchorctl repair DIR --until now");
  EXPECT_NE(at, std::string::npos) << told;
  EXPECT_EQ(told.find("anchorctl repair", at + 1), std::string::npos) << "once: " << told;
  EXPECT_EQ(statistics_.refused, 2u);
}

}  // namespace
}  // namespace anchord
