#include "maintenance/roi.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

bool inside(const RegionOfInterest& roi, const Eigen::Vector3d& x) {
  if (roi.kind == RegionOfInterest::Kind::kEllipsoid) {
    const Eigen::Vector2d d(x.x() - roi.center[0], x.y() - roi.center[1]);
    Eigen::Matrix2d p;
    p << roi.covariance[0], roi.covariance[1], roi.covariance[3], roi.covariance[4];
    return d.dot(p.inverse() * d) <= roi.radius * roi.radius;
  }
  Region region;
  for (const auto& corner : roi.polygon) region.polygon.emplace_back(corner[0], corner[1]);
  return region.contains(x, 2);
}

/// The share of draws from an object's density, by rejection for `somewhere`, that lie in a region.
double covered(const ObjectBelief& object, const std::vector<RegionOfInterest>& regions) {
  std::mt19937_64 dice(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  constexpr int kDraws = 20'000;
  int hits = 0;
  for (int n = 0; n < kDraws; ++n) {
    const Leaf& leaf = object.shown();
    double u = uniform(dice);
    std::size_t m = 0;
    while (m + 1 < leaf.models.size() && u >= leaf.models[m].weight) u -= leaf.models[m++].weight;
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    if (const auto* state = std::get_if<Kinematic>(&leaf.models[m].density)) {
      const Eigen::Matrix2d root = Eigen::Matrix2d(state->pp.topLeftCorner<2, 2>()).llt().matrixL();
      x.head<2>() = state->position.head<2>() + root * Eigen::Vector2d(normal(dice), normal(dice));
    } else {
      const auto& somewhere = std::get<Somewhere>(leaf.models[m].density);
      double most = 0;
      const Footprint& f = *somewhere.footprint();
      for (std::size_t i = 0; i < f.cells.size(); ++i)
        most = std::max(most, somewhere.mass_in(static_cast<int>(i)) / (f.share[i] * f.volume));
      do x = {10 * uniform(dice), 10 * uniform(dice), 0};
      while (uniform(dice) * most > somewhere.density(x));
    }
    hits += std::any_of(regions.begin(), regions.end(),
                        [&](const RegionOfInterest& roi) { return inside(roi, x); });
  }
  return static_cast<double>(hits) / kDraws;
}
constexpr double kSampling = 0.007;  // four deviations of 20,000 draws at 0.95

TEST(Roi, OneGaussianIsOneEllipsoidOfTheChiSquareQuantile) {
  World world(room());
  ASSERT_TRUE(world.apply(cups_at({{5, 5}}, kStart)).ok());
  const ObjectBelief object = only_object(world, 30);
  const auto regions = regions_of(object, *world.background());
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_NEAR(regions[0].radius, std::sqrt(-2 * std::log(0.05)), 1e-6);  // 2 degrees of freedom
  EXPECT_NEAR(regions[0].p, 0.95, 1e-6);
  EXPECT_NEAR(regions[0].covariance[0], 0.01 + 0.001 * 30, 1e-9);
  EXPECT_NEAR(covered(object, regions), 0.95, kSampling);
}

TEST(Roi, MixturesHoldTheirShareWhateverTheyConsistOf) {
  World world = with_a_cup_that_gets_lost(R"({"kind": "constant_position", "position_psd": 0.01})");
  // Somewhere weighs 1 - exp(-0.01 t): 0.02, 0.1, 0.63, 0.95.
  for (const double seconds : {2.0, 10.0, 100.0, 300.0}) {
    const ObjectBelief object = only_object(world, seconds);
    const auto regions = regions_of(object, *world.background());
    EXPECT_LE(regions.size(), kMaxRegions);
    EXPECT_GE(covered(object, regions), 0.95 - kSampling) << seconds;
    if (seconds == 2) {
      EXPECT_EQ(regions.size(), 1u);  // the ellipsoid suffices
    }
  }
}

TEST(Roi, WhereASensorLookedInVainIsLeftOut) {
  RoomOptions options;
  options.p_d = 0.9;
  options.models = R"([{"kind": "constant_position", "position_psd": 0.01},
                       {"kind": "somewhere", "rate": 0.02}])";
  World world(room(options));
  ASSERT_TRUE(world.apply(cups_at({{8, 8}}, kStart)).ok());
  for (int i = 1; i <= 20; ++i) {  // the left half, the object, but for a strip on the right
    Frame empty = cups_at({}, kStart + from_seconds(60 + 0.01 * i));
    empty.view->type = View::Type::kPolygon;
    empty.view->points = {{0, 0}, {9, 0}, {9, 10}, {0, 10}};
    ASSERT_TRUE(world.apply(empty).ok());
  }
  auto all = read_objects(*world.belief(), world.belief()->utime, 0, *world.background());
  ASSERT_EQ(all.size(), 1u);
  const auto regions = regions_of(all[0], *world.background());
  EXPECT_GE(covered(all[0], regions), 0.95 - kSampling);
  double area = 0;
  for (const RegionOfInterest& roi : regions) {
    if (roi.kind == RegionOfInterest::Kind::kEllipsoid) {  // what moved on by itself
      EXPECT_GT(roi.center[0], 9);
      continue;
    }
    for (const auto& corner : roi.polygon) EXPECT_GE(corner[0], 9 - 1e-9);
    Region region;
    for (const auto& corner : roi.polygon) region.polygon.emplace_back(corner[0], corner[1]);
    area += region.area();
  }
  EXPECT_NEAR(area, 10, 0.6);  // the strip; 95 % of it would do
}

TEST(Roi, ADensityWithoutWidthHasARegion) {
  RoomOptions options;
  options.models = R"([{"kind": "constant_position", "position_psd": 0}])";
  World world(room(options));
  Frame frame = cups_at({{2, 2}}, kStart);
  // Its determinant is no number above 0.
  std::get<CartesianMeasurement>(frame.detections[0].measurement).covariance = {1e-180, 0, 0,
                                                                                1e-180};
  ASSERT_TRUE(world.apply(frame).ok());
  const auto objects = read_objects(*world.belief(), kStart, 0, *world.background());
  ASSERT_FALSE(objects.empty());
  const auto regions = regions_of(objects[0], *world.background());
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_LT(regions[0].radius * std::sqrt(regions[0].covariance[0]), 1e-3);
}

TEST(Roi, TheAppearanceIsWhatWasReported) {
  World world(room());
  Frame frame = cups_at({{5, 5}}, kStart);
  ASSERT_TRUE(world.apply(frame).ok());
  EXPECT_TRUE(appearance_of(only_object(world, 0), *world.background()).empty());
}

}  // namespace
}  // namespace anchord
