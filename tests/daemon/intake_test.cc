#include "daemon/intake.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

using std::chrono::seconds;

TEST(Intake, RefusesWhatFindsNoRoomUntilHalfIsFree) {
  Intake intake;
  Intake::Clock::time_point now;
  EXPECT_FALSE(intake.enter(Intake::kFrames + 1, 0, now)) << "more than may ever wait";
  intake.leave(0, 0, now);
  for (std::size_t i = 0; i < Intake::kFrames; ++i) EXPECT_TRUE(intake.enter(1, 100, now));
  EXPECT_FALSE(intake.state(now).overloaded) << "full, and nothing was refused";
  EXPECT_FALSE(intake.enter(1, 100, now));
  EXPECT_FALSE(intake.enter(1, 100, now += seconds(2)));
  const auto full = intake.state(now += seconds(1));
  EXPECT_TRUE(full.overloaded);
  EXPECT_EQ(full.overloaded_s, 3) << "from the first refusal on";
  EXPECT_EQ(full.frames, Intake::kFrames);
  EXPECT_EQ(full.bytes, Intake::kFrames * 100);

  intake.leave(1, 100, now);
  EXPECT_TRUE(intake.enter(1, 100, now)) << "there is room again";
  EXPECT_TRUE(intake.state(now).overloaded) << "and not for long, perhaps";
  for (std::size_t i = 0; i < Intake::kFrames / 2; ++i) intake.leave(1, 100, now);
  EXPECT_FALSE(intake.state(now).overloaded);
  EXPECT_EQ(intake.state(now).overloaded_s, 0);
}

TEST(Intake, LargeFramesTakeMoreRoom) {
  Intake intake;
  const Intake::Clock::time_point now;
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(intake.enter(1, Intake::kBytes / 8, now));
  EXPECT_FALSE(intake.enter(1, 1, now));
  EXPECT_EQ(intake.state(now).frames, 8u);
  for (int i = 0; i < 4; ++i) intake.leave(1, Intake::kBytes / 8, now);
  EXPECT_FALSE(intake.state(now).overloaded);
  EXPECT_TRUE(intake.enter(1, Intake::kBytes / 2, now));
}

}  // namespace
}  // namespace anchord
