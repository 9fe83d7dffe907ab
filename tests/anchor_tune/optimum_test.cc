#include "tools/anchor_tune/optimum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace anchord::tuning {
namespace {

/// A normal log-likelihood with means 1 and -2, deviations 0.5 and 0.2, correlation 0.8.
double quadratic(const std::vector<double>& x) {
  const double a = (x[0] - 1) / 0.5, b = (x[1] + 2) / 0.2;
  return 3 - (a * a - 2 * 0.8 * a * b + b * b) / (2 * (1 - 0.8 * 0.8));
}

TEST(Optimum, FindsTheTopOfACorrelatedHill) {
  const Optimum best = maximise(quadratic, {0, 0}, 1, 400);
  // Within 0.001 of the value is within 0.05 deviations.
  EXPECT_NEAR(best.value, 3, 1e-3);
  EXPECT_NEAR(best.at[0], 1, 0.05 * 0.5);
  EXPECT_NEAR(best.at[1], -2, 0.05 * 0.2);
  EXPECT_LE(best.evaluations, 400);
}

// Of a normal likelihood both intervals are the mean and 1.96 deviations. Ends are found to 2 % of
// the width, the top to 0.05 deviations.
constexpr double kEnd = 0.1;

TEST(Optimum, ProfilesFallWhereTheNormalIntervalEnds) {
  const Optimum best = maximise(quadratic, {0, 0}, 1, 400);
  const Estimate a = profile_interval(quadratic, best, 0, Scale::kLog);
  EXPECT_NEAR(std::log(a.low), 1 - 1.96 * 0.5, kEnd * 0.5);
  EXPECT_NEAR(std::log(a.high), 1 + 1.96 * 0.5, kEnd * 0.5);
  const Estimate b = profile_interval(quadratic, best, 1, Scale::kLogit);
  EXPECT_NEAR(to_free(b.low, Scale::kLogit), -2 - 1.96 * 0.2, kEnd * 0.2);
  EXPECT_NEAR(to_free(b.high, Scale::kLogit), -2 + 1.96 * 0.2, kEnd * 0.2);
}

TEST(Optimum, CurvatureGivesTheSame) {
  Optimum best = maximise(quadratic, {0, 0}, 1, 400);
  const auto all = curvature_intervals(quadratic, best, {Scale::kLog, Scale::kLog});
  EXPECT_NEAR(std::log(all[0].high) - std::log(all[0].low), 2 * 1.96 * 0.5, kEnd * 0.5);
  EXPECT_NEAR(std::log(all[1].high) - std::log(all[1].low), 2 * 1.96 * 0.2, kEnd * 0.2);
}

TEST(Optimum, WhatDoesNotMatterGetsAllOfTheReach) {
  const auto flat = [](const std::vector<double>& x) { return -x[0] * x[0] / 2; };
  Optimum best{{0, 0}, 0, 0};
  EXPECT_NEAR(std::log(profile_interval(flat, best, 1, Scale::kLog).high), kReach, 1e-9);
  const auto all = curvature_intervals(flat, best, {Scale::kLog, Scale::kLog});
  EXPECT_NEAR(std::log(all[0].high), 1.96, 1e-6);
  EXPECT_NEAR(std::log(all[1].high), kReach, 1e-6);
}

TEST(Optimum, ScalesGoThereAndBack) {
  EXPECT_NEAR(from_free(to_free(0.3, Scale::kLogit), Scale::kLogit), 0.3, 1e-15);
  EXPECT_NEAR(from_free(to_free(20, Scale::kLog), Scale::kLog), 20, 1e-13);
}

}  // namespace
}  // namespace anchord::tuning
