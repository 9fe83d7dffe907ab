#include <gtest/gtest.h>

#include "tests/anchor_tune/street.h"
#include "tests/anchoring/dice.h"
#include "tests/anchoring/small_world.h"
#include "tools/anchor_tune/births.h"

namespace anchord::tuning {
namespace {

using enumeration::Dice;

JudgedFrame frame_with(double seconds, std::vector<std::string> objects, bool seen_before) {
  JudgedFrame f;
  f.utime = at_second(seconds);
  f.volume = 100;
  f.new_volume = seen_before ? 0 : 100;
  f.old_seconds = seen_before ? 100 : 0;
  for (auto& id : objects) f.sights.push_back({id, 0, {}, true, seen_before});
  return f;
}

TEST(Births, ComingAndGoingIsCounted) {
  Judgement judgement;
  judgement.frames = {frame_with(0, {"a", "b"}, false), frame_with(1, {"a", "b", "c"}, true),
                      frame_with(2, {"a", "c"}, true), frame_with(3, {"a"}, true)};
  const Turnover t = turnover_of(judgement, 0);
  EXPECT_EQ(t.there, 2);
  EXPECT_EQ(t.arrivals.size(), 1u);
  EXPECT_EQ(t.ends, 2);
  // a for 3 s, b gone at 2 s, c from 1 s to 3 s.
  EXPECT_NEAR(t.object_seconds, 3 + 2 + 2, 1e-9);
  EXPECT_NEAR(t.exposure, 300, 1e-9);
  EXPECT_NEAR(t.seconds, 3, 1e-9);
  EXPECT_NEAR(t.new_volume, 100, 1e-9);
  EXPECT_EQ(turnover_of(judgement, 1).there, 0);
}

TEST(Births, NewlyViewedSpaceIsNoArrival) {
  Judgement judgement;
  judgement.frames = {frame_with(0, {}, false), frame_with(1, {"a"}, false)};
  const Turnover t = turnover_of(judgement, 0);
  EXPECT_EQ(t.there, 1);
  EXPECT_TRUE(t.arrivals.empty());
}

TEST(Births, GatesAreFoundAmongOthers) {
  std::mt19937_64 random(23);
  Dice dice(random);
  std::vector<Eigen::Vector3d> arrivals;
  for (int i = 0; i < 30; ++i) {
    arrivals.emplace_back(10 + 0.5 * dice.normal(), 20 + 0.5 * dice.normal(), 0);
    arrivals.emplace_back(70 + 2 * dice.normal(), 80 + 1 * dice.normal(), 0);
    arrivals.emplace_back(dice.uniform(0, 100), dice.uniform(0, 100), 0);
  }
  auto gates = fit_gates(arrivals, 1e4, 6, 0.1, 2);
  ASSERT_EQ(gates.size(), 2u);
  if (gates[0].mean.x() > gates[1].mean.x()) std::swap(gates[0], gates[1]);
  // Means of 30: a deviation of 0.1 and 0.4 m; shares: of 0.05. Four of them.
  EXPECT_NEAR(gates[0].mean.x(), 10, 0.4);
  EXPECT_NEAR(gates[1].mean.x(), 70, 1.6);
  EXPECT_NEAR(gates[0].share, 1.0 / 3, 0.2);
  EXPECT_NEAR(gates[1].share, 1.0 / 3, 0.2);
  // A variance of 30 is known to a quarter.
  EXPECT_NEAR(gates[1].covariance(0, 0), 4, 4);
}

TEST(Births, EvenArrivalsHaveNoGate) {
  std::mt19937_64 random(29);
  Dice dice(random);
  std::vector<Eigen::Vector3d> arrivals;
  for (int i = 0; i < 60; ++i) arrivals.emplace_back(dice.uniform(0, 100), dice.uniform(0, 100), 0);
  EXPECT_TRUE(fit_gates(arrivals, 1e4, 6, 0.1, 2).empty());
}

}  // namespace
}  // namespace anchord::tuning
