#include "geometry/region_of_interest.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace anchord {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

RegionOfInterest ellipsoid(std::array<double, 9> covariance, double radius) {
  RegionOfInterest roi;
  roi.center = {2, -1, 0.5};
  roi.covariance = covariance;
  roi.radius = radius;
  return roi;
}

RegionOfInterest prism() {
  RegionOfInterest roi;
  roi.kind = RegionOfInterest::Kind::kPrism;
  roi.polygon = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  roi.z = {0.5, 1.5};
  return roi;
}

TEST(RegionOfInterest, APrismIsWhatItIs) {
  const Region region = prism_of(prism());
  EXPECT_EQ(region.polygon.size(), 6u);
  EXPECT_NEAR(region.volume(3), 3, 1e-12);
  EXPECT_EQ(region.z_min, 0.5);
  EXPECT_EQ(region.z_max, 1.5);
}

TEST(RegionOfInterest, AnEllipsoidsShadowHasItsAreaAndHeight) {
  const double radius = 2.5;
  const Region region =
      prism_of(ellipsoid({0.04, 0.01, 0, 0.01, 0.09, 0.005, 0, 0.005, 0.01}, radius));
  const double determinant = 0.04 * 0.09 - 0.01 * 0.01;
  EXPECT_NEAR(region.area(), std::numbers::pi * radius * radius * std::sqrt(determinant), 1e-12);
  EXPECT_NEAR(region.z_min, 0.5 - radius * 0.1, 1e-12);
  EXPECT_NEAR(region.z_max, 0.5 + radius * 0.1, 1e-12);
}

RC_GTEST_PROP(RegionOfInterest, AnEllipsoidsShadowIsThatOfItsSurface, ()) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) * 0.01; };
  const double a = number(1, 100), b = number(1, 100), radius = number(10, 400);
  const double c = 0.9 * number(-100, 101) * std::sqrt(a * b);
  const Region region = prism_of(ellipsoid({a, c, 0, c, b, 0, 0, 0, 1}, radius));
  Eigen::Matrix2d shadow;
  shadow << a, c, c, b;
  for (const auto& corner : region.polygon) {
    const Eigen::Vector2d d = corner - Eigen::Vector2d(2, -1);
    // 48 sides with a circle's area: corners lie 0.14 % outside of it.
    RC_ASSERT(std::abs(std::sqrt(d.dot(shadow.ldlt().solve(d))) / radius - 1) < 0.0015);
  }
}

struct Fault {
  const char* field;
  RegionOfInterest roi;
};

template <typename Change>
RegionOfInterest changed(RegionOfInterest roi, Change change) {
  change(roi);
  return roi;
}

TEST(RegionOfInterest, RefusesWhatIsNone) {
  const RegionOfInterest round = ellipsoid({0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1}, 2);
  const auto inf = std::numeric_limits<double>::infinity();
  const std::vector<Fault> faults{
      {"r.p", changed(round, [](auto& r) { r.p = -0.1; })},
      {"r.p", changed(round, [](auto& r) { r.p = 1.1; })},
      {"r.p", changed(round, [](auto& r) { r.p = kNaN; })},
      {"r.radius", changed(round, [](auto& r) { r.radius = 0; })},
      {"r.radius", changed(round, [](auto& r) { r.radius = -1; })},
      {"r.radius", changed(round, [=](auto& r) { r.radius = inf; })},
      {"r.center", changed(round, [](auto& r) { r.center[2] = kNaN; })},
      {"r.covariance", changed(round, [](auto& r) { r.covariance[8] = 0; })},
      {"r.covariance", changed(round, [](auto& r) { r.covariance[1] = 0.01; })},
      {"r.covariance", changed(round, [](auto& r) { r.covariance[4] = kNaN; })},
      {"r.polygon", changed(prism(), [](auto& r) { r.polygon.resize(2); })},
      {"r.polygon", changed(prism(), [](auto& r) { std::swap(r.polygon[0], r.polygon[1]); })},
      {"r.polygon", changed(prism(), [](auto& r) { r.polygon[0][1] = kNaN; })},
      {"r.z", changed(prism(),
                      [](auto& r) {
                        r.z = {1, 1};
                      })},
      {"r.z", changed(prism(),
                      [](auto& r) {
                        r.z = {2, 1};
                      })},
      {"r.z", changed(prism(),
                      [](auto& r) {
                        r.z = {0, kNaN};
                      })},
      {"r.z", changed(prism(),
                      [=](auto& r) {
                        r.z = {0, inf};
                      })},
  };
  for (const Fault& fault : faults) {
    const Status refused = check_region(fault.roi, 3, "r");
    ASSERT_FALSE(refused.ok()) << fault.field;
    EXPECT_EQ(refused.error().field.substr(0, refused.error().field.find('[')), fault.field);
  }
  EXPECT_TRUE(check_region(round, 3, "r").ok());
  EXPECT_TRUE(check_region(prism(), 3, "r").ok());
}

TEST(RegionOfInterest, A2DWorldDoesNotLookAtHeights) {
  const RegionOfInterest flat = ellipsoid({0.1, 0, 0, 0, 0.1, 0, 0, 0, 0}, 2);
  EXPECT_TRUE(check_region(flat, 2, "r").ok());
  EXPECT_FALSE(check_region(flat, 3, "r").ok());
  const RegionOfInterest low = changed(prism(), [](auto& r) { r.z = {0, 0}; });
  EXPECT_TRUE(check_region(low, 2, "r").ok());
}

}  // namespace
}  // namespace anchord
