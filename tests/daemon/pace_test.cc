#include "daemon/pace.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

TEST(Pace, WithoutABudgetThereIsNoBound) {
  Pace pace(0);
  pace.took(1000, 1);
  EXPECT_EQ(pace.work(), std::nullopt);
}

TEST(Pace, TheBoundIsWhatTheMachineDoesInThatTime) {
  Pace pace(0.005);
  for (int frame = 0; frame < 200; ++frame) pace.took(20'000, 0.002);  // 1e7 per second
  EXPECT_NEAR(static_cast<double>(*pace.work()), 50'000, 50);
  pace.took(50'000, 1);  // the machine stood still for a second
  EXPECT_LT(*pace.work(), 40'000u);
  for (int frame = 0; frame < 200; ++frame) pace.took(20'000, 0.002);
  EXPECT_NEAR(static_cast<double>(*pace.work()), 50'000, 50);
}

TEST(Pace, WhatSaysNothingIsPassedOver) {
  Pace pace(0.005);
  const auto first = pace.work();
  pace.took(1, 0.001);  // slow, but only because it is short
  pace.took(1000, 0);
  pace.took(0, 1);
  EXPECT_EQ(pace.work(), first);
  EXPECT_GE(*Pace(1e-12).work(), 1u) << "there is always something to do";
}

}  // namespace
}  // namespace anchord
