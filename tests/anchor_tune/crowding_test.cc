#include "tools/anchor_tune/crowding.h"

#include <gtest/gtest.h>

#include "tests/anchoring/dice.h"

namespace anchord::tuning {
namespace {

using enumeration::Dice;

/// 200 frames of 100 x 100 m in which right detections lie in the left `right_to` m and false ones
/// in the left `false_to` m, ten of each to a frame.
double crowding_of(double right_to, double false_to, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Dice dice(random);
  Judgement judgement;
  judgement.sensors = {"camera"};
  for (int f = 0; f < 200; ++f) {
    JudgedFrame& frame = judgement.frames.emplace_back();
    frame.volume = 1e4;
    for (int i = 0; i < 20; ++i) {
      Judged& z = frame.detections.emplace_back();
      z.verdict = i % 2 == 0 ? Verdict::kRight : Verdict::kFalse;
      z.in_sensor << dice.uniform(0, i % 2 == 0 ? right_to : false_to), dice.uniform(0, 100), 0;
    }
  }
  return crowding(judgement, 0, 2, 2);
}

TEST(Crowding, IsOneWhereClutterIsEven) {
  EXPECT_EQ(crowding_of(100, 100, 1), 1);
  EXPECT_EQ(crowding_of(20, 100, 2), 1);
}

TEST(Crowding, IsTheDensityWhereRightOnesAre) {
  // All clutter in a fifth of the view, with all right ones, or a third of them. Within 2 m of the
  // border at 20 m a circle is cut: less by 2 to 5 %.
  EXPECT_NEAR(crowding_of(20, 20, 3), 5, 0.4);
  EXPECT_NEAR(crowding_of(60, 20, 4), 5.0 / 3, 0.15);
}

TEST(Crowding, FewPairsSayNothing) {
  Judgement judgement;
  judgement.sensors = {"camera"};
  for (int f = 0; f < 2; ++f) {
    JudgedFrame& frame = judgement.frames.emplace_back();
    frame.volume = 1e6;
    frame.detections.resize(2);
    frame.detections[0].verdict = Verdict::kRight;
    frame.detections[1].verdict = Verdict::kFalse;
  }
  EXPECT_EQ(crowding(judgement, 0, 1, 2), 1);
}

}  // namespace
}  // namespace anchord::tuning
