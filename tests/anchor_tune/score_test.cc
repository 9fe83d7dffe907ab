#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/dice.h"
#include "tools/anchor_tune/scores.h"

namespace anchord::tuning {
namespace {

using enumeration::Dice;

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

/// Scores whose right ones follow logit p' = a + b logit p.
std::vector<JudgedScore> scores_off_by(double a, double b, int count, Dice& dice) {
  std::vector<JudgedScore> scores;
  for (int i = 0; i < count; ++i) {
    const double logit = 2 * dice.normal();
    scores.push_back({logistic(logit), dice.chance(logistic(a + b * logit))});
  }
  return scores;
}

TEST(Scores, CalibratedOnesAreLeftAsTheyAre) {
  std::mt19937_64 random(3);
  Dice dice(random);
  for (int run = 0; run < 20; ++run) {
    const auto calibration = calibrate(scores_off_by(0, 1, 1000, dice));
    ASSERT_TRUE(calibration);
    EXPECT_FALSE(calibration->off);  // chi-squared (2) over 13.8: one in a thousand
  }
}

TEST(Scores, WhatIsOffIsFound) {
  std::mt19937_64 random(5);
  Dice dice(random);
  int inside = 0;
  for (int run = 0; run < 20; ++run) {
    const auto calibration = calibrate(scores_off_by(-0.7, 0.6, 1000, dice));
    ASSERT_TRUE(calibration);
    EXPECT_TRUE(calibration->off);
    inside += calibration->a.low < -0.7 && -0.7 < calibration->a.high;
    inside += calibration->b.low < 0.6 && 0.6 < calibration->b.high;
  }
  EXPECT_GE(inside, 33);  // of 40; 38 expected, fewer in one run of five hundred
}

TEST(Scores, WhatDistanceSaysIsFound) {
  std::mt19937_64 random(7);
  Dice dice(random);
  int inside = 0;
  for (int run = 0; run < 20; ++run) {
    std::vector<JudgedScore> scores;
    for (int i = 0; i < 1000; ++i) {
      const double logit = 2 * dice.normal(), range = dice.uniform(0, 60);
      scores.push_back(
          {logistic(logit), dice.chance(logistic(-2 + 1.2 * logit + 0.08 * range)), range});
    }
    const auto calibration = calibrate(scores);
    ASSERT_TRUE(calibration && calibration->per_m);
    EXPECT_TRUE(calibration->off);
    inside += calibration->per_m->low < 0.08 && 0.08 < calibration->per_m->high;
  }
  EXPECT_GE(inside, 16);  // of 20, each in 19 of 20: fewer in one of four hundred
}

TEST(Scores, NothingIsToldFromOneKind) {
  EXPECT_FALSE(calibrate({}));
  EXPECT_FALSE(calibrate({{0.4, true}, {0.6, true}}));
  EXPECT_FALSE(calibrate({{0.5, true}, {0.5, false}}));
}

}  // namespace
}  // namespace anchord::tuning
