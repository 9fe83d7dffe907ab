// A log within bounds: what is old goes, and the belief is what it would have been.

#include "daemon/retention.h"

#include <gtest/gtest.h>

#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/journal.h"
#include "daemon/past.h"
#include "tests/daemon/answers.h"
#include "tests/daemon/scene.h"

namespace anchord {
namespace {

class RetentionTest : public ::testing::Test {
 protected:
  static Knowledge within(double keep_s, std::int64_t max_bytes) {
    auto document = nlohmann::json::parse(kScene);
    document["log"] = {{"keep", keep_s}, {"max_bytes", max_bytes}};
    const auto configuration = parse_configuration(document.dump());
    EXPECT_TRUE(configuration.ok());
    return configuration.knowledge();
  }
  void start(const Knowledge& knowledge) {
    journal_.reset();
    auto log = FrameLog::open(folder_ / "data");
    ASSERT_TRUE(log.ok());
    now_.emplace(knowledge);
    journal_ =
        std::make_unique<Journal>(*now_, *std::move(log), statistics_, times_, Journal::Hooks{},
                                  std::make_unique<Checkpointer>(folder_ / "data", *now_, 0));
    ASSERT_TRUE(journal_->restore(std::atomic<bool>{false}).ok());
    journal_->start();
  }
  void send(int number) {
    std::promise<bool> done;
    ASSERT_TRUE(journal_->submit({{frame_number(number)}, "test", false, [&](Result<Receipt> r) {
                                    done.set_value(r.ok());
                                  }}));
    ASSERT_TRUE(done.get_future().get());
  }
  /// Sends frames until the log has dropped some; the number of the next one.
  int live_until_dropped(int number, std::int64_t first) {
    for (int most = number + 20'000; journal_->kept().first <= first && number < most; ++number)
      send(number);
    EXPECT_GT(journal_->kept().first, first);
    return number;
  }
  std::string replay(int until) const {
    World world(scene());
    for (int i = 1; i <= until; ++i) EXPECT_TRUE(world.apply(frame_number(i)).ok());
    return answers({world.belief(), world.background()});
  }

  TestFolder folder_;
  Statistics statistics_;
  UpdateTimes times_;
  std::optional<World> now_;
  std::unique_ptr<Journal> journal_;
};

TEST_F(RetentionTest, WhatIsTooOldGoesAndTheBeliefStays) {
  start(within(5, 0));
  const int next = live_until_dropped(1, 50);
  const std::int64_t kept = journal_->logged_frames() - journal_->kept().first + 1;
  EXPECT_GE(kept * 0.033, 5 - 0.1) << "what is younger than 5 s stays";
  EXPECT_EQ(answers(journal_->snapshot()), replay(next - 1));

  // A start goes on from what is left, with and without checkpoints beside it.
  for (const bool checkpoints : {true, false}) {
    journal_.reset();
    if (!checkpoints) std::filesystem::remove(folder_ / "data/anchord.db-checkpoints");
    start(within(5, 0));
    EXPECT_EQ(answers(journal_->snapshot()), replay(next - 1)) << checkpoints;
  }

  // The past is there as far as the log is.
  Past past(folder_ / "data", *now_);
  const auto then = past.at(frame_number(next - 20).utime, journal_->logged_frames());
  ASSERT_TRUE(then.ok());
  EXPECT_EQ(answers(*then), replay(next - 20));
  const auto gone = past.at(frame_number(3).utime, journal_->logged_frames());
  ASSERT_FALSE(gone.ok());
  EXPECT_EQ(gone.error().code, ErrorCode::kUnknown);
  EXPECT_EQ(gone.error().field, "at");
}

TEST_F(RetentionTest, TheDatabaseStaysWithinItsBound) {
  constexpr std::int64_t kBound = 400'000;
  start(within(0, kBound));
  int next = 1;
  std::int64_t largest = 0;
  for (std::int64_t dropped = 0; dropped < 3000 && next < 20'000; ++next) {
    send(next);
    dropped = journal_->kept().first;
    largest = std::max(largest, journal_->kept().used + journal_->kept().free);
  }
  EXPECT_GE(journal_->kept().first, 3000);
  EXPECT_LT(largest, 3 * kBound) << "used, free, and what is added before a base is found";
  EXPECT_EQ(answers(journal_->snapshot()), replay(next - 1));
}

}  // namespace
}  // namespace anchord
