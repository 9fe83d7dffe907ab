// What is far is missed more often: against closed forms in the 6 x 4 m apartment. That all of it
// is consistent is for the enumeration (exactness_test.cc).

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr double kNear = 0.9, kPerM = -1;
constexpr double kIntensity = 0.02, kClutter = 1e-3;  // small_world()'s, of both classes
constexpr double kExactly = 1e-12;                    // rounding

double detected(double range) {
  const double odds = kNear / (1 - kNear) * std::exp(kPerM * range);
  return odds / (1 + odds);
}

Knowledge knowledge() {
  return small_world(R"({"classes": {"default": {"detection_probability": [0.9, -1]}}})");
}

/// From (0, 2).
Frame seen(double seconds, std::vector<Detection> detections, bool says_where = true) {
  Frame out = frame(seconds, std::move(detections));
  if (says_where) out.pose.emplace().position = {0, 2, 0};
  return out;
}

double after_miss(double r, double p) { return r * (1 - p) / (1 - r * p); }

TEST(Distance, WhatIsFarIsDetectedAndMissedByItsOwnProbability) {
  World world(knowledge());
  apply(world, {seen(0, {at(1, 0), at(5, 0)})});
  std::vector<double> r;
  for (const double range : {1.0, 5.0}) {
    const double e = detected(range) * kIntensity;
    r.push_back(e / (kClutter + e));
  }
  ASSERT_EQ(objects(world).size(), 2u);
  for (const int i : {0, 1}) EXPECT_NEAR(objects(world)[i].p, r[i], kExactly);
  apply(world, {seen(1, {})});
  EXPECT_NEAR(objects(world)[0].p, after_miss(r[0], detected(1)), kExactly);
  EXPECT_NEAR(objects(world)[1].p, after_miss(r[1], detected(5)), kExactly);
}

TEST(Distance, FromNowhereNothingIsFar) {
  World world(knowledge());
  apply(world, {seen(0, {at(5, 2)}, false), seen(1, {}, false)});
  const double e = kNear * kIntensity;
  EXPECT_NEAR(objects(world)[0].p, after_miss(e / (kClutter + e), kNear), kExactly);
}

TEST(Distance, ALookFromElsewhereIsAnother) {
  World world(knowledge());
  Frame beside = seen(1, {});
  beside.pose->position = {4, 2, 0};
  apply(world, {seen(0, {at(5, 0)}), beside, seen(2, {})});
  const double e = detected(5) * kIntensity, r = e / (kClutter + e);
  EXPECT_NEAR(objects(world)[0].p, after_miss(after_miss(r, detected(1)), detected(5)), kExactly);
}

}  // namespace
}  // namespace anchord
