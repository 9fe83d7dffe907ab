#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/view.h"
#include "tests/geometry/sampling.h"

namespace anchord {
namespace {

/// What view.h promises.
constexpr double kQuadrature = 1e-6;

View sector(double near, double far, double from, double to) {
  View view;
  view.type = View::Type::kSector;
  view.range = {near, far};
  view.bearing = {from, to};
  return view;
}

View frustum(double hfov, double vfov, double near, double far) {
  View view;
  view.type = View::Type::kFrustum;
  view.range = {near, far};
  view.hfov = hfov;
  view.vfov = vfov;
  return view;
}

View random_view(Sampler& sampler, View::Type type) {
  View view =
      frustum(sampler.uniform(0.2, 2.8), sampler.uniform(0.2, 2.2), 0, sampler.uniform(3, 8));
  view.type = type;
  if (sampler.normal() > 0) view.range[0] = sampler.uniform(0.2, 2.5);
  view.bearing[0] = sampler.uniform(-4, 4);
  view.bearing[1] = view.bearing[0] + sampler.uniform(0.3, 7);  // at times the whole circle
  view.elevation[0] = sampler.uniform(-1.5, 0.8);
  view.elevation[1] = view.elevation[0] + sampler.uniform(0.2, 1.5);
  return view;
}

MapView placed(const View& view, const std::optional<Pose>& pose, int dims) {
  return *MapView::place(view, pose, dims);
}

double heading(const Pose& pose) {
  const auto& [w, x, y, z] = pose.orientation;
  return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

Eigen::Vector3d to_sensor(const Pose& pose, const Eigen::Vector3d& p, int dims) {
  const Eigen::Vector3d offset = p - Eigen::Vector3d(pose.position.data());
  const auto& q = pose.orientation;
  if (dims == 3) return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).conjugate() * offset;
  return Eigen::AngleAxisd(-heading(pose), Eigen::Vector3d::UnitZ()) *
         Eigen::Vector3d(offset.x(), offset.y(), 0);
}

/// Random views, poses tilted every way, densities of all shapes near and around the sensor.
void compare_with_sampling(View::Type type, int dims, unsigned seed) {
  Sampler sampler(seed);
  int cut = 0;
  for (int i = 0; i < 50; ++i) {
    const View view = random_view(sampler, type);
    const Eigen::Vector3d position(sampler.uniform(-3, 3), sampler.uniform(-3, 3),
                                   sampler.uniform(-1, 1));
    const Pose pose = exact_pose(position, sampler.orientation());
    Gaussian density{position, sampler.covariance(0.01, i % 3 ? 1 : 8, dims)};
    density.mean += 3 * Eigen::Vector3d(sampler.normal(), sampler.normal(), sampler.normal());
    if (dims == 2) density.mean.z() = 0;
    const double mass = placed(view, pose, dims).mass(density);
    const Share share = sampled_share(sampler, density, 20'000, [&](const Eigen::Vector3d& p) {
      return in_view(view, to_sensor(pose, p, dims), dims);
    });
    // 4.5 standard errors: 200 comparisons exceed it once in 700 seeds.
    EXPECT_NEAR(mass, share.value, 4.5 * share.error) << "comparison " << i;
    cut += mass > 0 && mass < 1;
  }
  EXPECT_GT(cut, 15) << "too few densities lie on the edge of their view";
}

TEST(ViewMass, OfSectorsAgreesWithSamplingIn2D) {
  compare_with_sampling(View::Type::kSector, 2, 1);
}
TEST(ViewMass, OfSectorsAgreesWithSamplingIn3D) {
  compare_with_sampling(View::Type::kSector, 3, 2);
}
TEST(ViewMass, OfFrustumsAgreesWithSamplingIn2D) {
  compare_with_sampling(View::Type::kFrustum, 2, 3);
}
TEST(ViewMass, OfFrustumsAgreesWithSamplingIn3D) {
  compare_with_sampling(View::Type::kFrustum, 3, 4);
}

TEST(ViewMass, IsAsExactAsItIsWanted) {
  Sampler sampler(11);
  int rougher = 0;
  for (int i = 0; i < 400; ++i) {
    const int dims = i % 4 ? 3 : 2;
    const View view = random_view(sampler, i % 3 ? View::Type::kSector : View::Type::kFrustum);
    const Pose pose = exact_pose({0, 0, 0}, sampler.orientation());
    Gaussian density{3 * Eigen::Vector3d(sampler.normal(), sampler.normal(), sampler.normal()),
                     sampler.covariance(0.01, i % 3 ? 1 : 8, dims)};
    if (dims == 2) density.mean.z() = 0;
    const MapView at = placed(view, pose, dims);
    const double exact = at.mass(density);
    for (const double tolerance : {1e-5, 1e-4, 1e-3, 1e-2}) {
      const double rough = at.mass(density, tolerance);
      // Each of the limits may be left out, and two integrals end early.
      EXPECT_NEAR(rough, exact, 3 * tolerance) << "density " << i;
      rougher += rough != exact;
    }
  }
  EXPECT_GT(rougher, 100) << "nothing was spared";
}

TEST(ViewMass, AroundTheSensorIsTheShareOfTheCircleOrSphere) {
  // A round density about the sensor: angles and range are independent, Rayleigh in 2-D and
  // Maxwell in 3-D.
  for (double sigma : {0.05, 1.0, 20.0}) {
    const Gaussian density{{0, 0, 0}, sigma * sigma * Eigen::Matrix3d::Identity()};
    const double near = 0.5 / sigma, far = 4 / sigma;
    const double rayleigh = std::exp(-near * near / 2) - std::exp(-far * far / 2);
    EXPECT_NEAR(placed(sector(0.5, 4, 3, -3), {}, 2).mass(density),
                rayleigh * (2 * kPi - 6) / (2 * kPi), kQuadrature);
    EXPECT_NEAR(placed(sector(0.5, 4, -kPi, kPi), {}, 2).mass(density), rayleigh, kQuadrature);
    const auto maxwell = [](double x) {
      return std::erf(x / std::sqrt(2)) - std::sqrt(2 / kPi) * x * std::exp(-x * x / 2);
    };
    View view = sector(0.5, 4, -1, 2);
    view.elevation = {-0.3, 0.7};
    const double solid_angle = 3 * (std::sin(0.7) + std::sin(0.3)) / (4 * kPi);
    EXPECT_NEAR(placed(view, {}, 3).mass(density), solid_angle * (maxwell(far) - maxwell(near)),
                kQuadrature);
    // A pyramid's solid angle: van Oosterom's 4 asin(sin(h/2) sin(v/2)).
    const double pyramid = 4 * std::asin(std::sin(0.5) * std::sin(0.4)) / (4 * kPi);
    EXPECT_NEAR(placed(frustum(1.0, 0.8, 0.5, 4), {}, 3).mass(density),
                pyramid * (maxwell(far) - maxwell(near)), kQuadrature);
  }
}

TEST(ViewMass, OfAFlatHugeDensityIsItsHeightTimesTheViewsVolume) {
  // Over 5 m it changes by 5 * 112 / sigma^2 = 6e-6 of its height.
  const double sigma = 1e4;
  const Gaussian density{{100, 50, 0}, sigma * sigma * Eigen::Matrix3d::Identity()};
  const double area = 25 * 0.5;  // r^2 w / 2, w = 1
  const double expected = area / (2 * kPi * sigma * sigma) * std::exp(-0.5 * 12500 / 1e8);
  EXPECT_NEAR(placed(sector(0, 5, 0, 1), {}, 2).mass(density) / expected, 1, 6e-6);
}

TEST(ViewMass, OfNarrowDensitiesOnAnEdgeIsTheNormalDistribution) {
  const double sigma = 1e-3;
  const auto phi = [](double x) { return std::erfc(-x / std::sqrt(2)) / 2; };
  const Eigen::Matrix3d covariance = sigma * sigma * Eigen::Matrix3d::Identity();
  for (int dims : {2, 3}) {
    for (double off : {-2.0, 0.0, 0.5, 3.0}) {
      // 100 m away and `off` standard deviations inside the bearing limit at 0.
      const MapView view = placed(sector(0, 200, 0, 1), {}, dims);
      EXPECT_NEAR(view.mass({{100, off * sigma, 0}, covariance}), phi(off), kQuadrature);
      // The same off the far limit, which at 200 m curves by sigma / 200 m over the density.
      EXPECT_NEAR(view.mass({{200 * std::cos(0.5) - off * sigma * std::cos(0.5),
                              200 * std::sin(0.5) - off * sigma * std::sin(0.5), 0},
                             covariance}),
                  phi(off), kQuadrature + sigma / 200);
    }
  }
}

TEST(ViewMass, ComesTogetherFromPartsOfTheView) {
  Sampler sampler(7);
  for (int i = 0; i < 60; ++i) {
    const int dims = i % 2 ? 2 : 3;
    const Gaussian density{{sampler.uniform(-4, 4), sampler.uniform(-4, 4), 0},
                           sampler.covariance(0.1, 2, dims)};
    const double cut = sampler.uniform(1, 4);
    const auto mass = [&](const View& view) { return placed(view, {}, dims).mass(density); };
    EXPECT_NEAR(mass(sector(0, 5, 2, -2)),
                mass(sector(0, cut, 2, -2)) + mass(sector(cut, 5, 2, -2)), 3 * kQuadrature);
    EXPECT_NEAR(mass(sector(0, 5, -kPi, kPi)),
                mass(sector(0, 5, -cut, cut / 2)) + mass(sector(0, 5, cut / 2, -cut)),
                3 * kQuadrature);
  }
}

TEST(ViewMass, IsExactlyOneWellInsideAndZeroFarOutside) {
  const Eigen::Matrix3d covariance = 0.01 * Eigen::Matrix3d::Identity();
  for (int dims : {2, 3}) {
    for (const View& view : {sector(0.5, 10, -1, 1), frustum(2, 1.5, 0.5, 10)}) {
      const MapView at = placed(view, {}, dims);
      EXPECT_EQ(at.mass({{5, 0, 0}, covariance}), 1);
      EXPECT_EQ(at.mass({{-5, 0, 0}, covariance}), 0);
      EXPECT_EQ(at.mass({{13, 0, 0}, covariance}), 0);
      EXPECT_EQ(at.mass({{5, 0, 0}, Eigen::Matrix3d::Zero()}), 1);
      EXPECT_EQ(at.mass({{-5, 0, 0}, Eigen::Matrix3d::Zero()}), 0);
    }
  }
}

TEST(ViewMass, OfAPolygonTurnsWithTheSensor) {
  View view;
  view.type = View::Type::kPolygon;
  view.points = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  const Pose pose = exact_pose({1, 1, 5}, turned(kPi / 2, {0, 0, 1}));
  // In the map: x in [0, 1], y in [1, 3].
  for (int dims : {2, 3}) {
    const MapView at = placed(view, pose, dims);
    EXPECT_NEAR(at.mass({{0, 2, 0}, 1e-4 * Eigen::Matrix3d::Identity()}), 0.5, 1e-12);
    EXPECT_NEAR(at.mass({{0.5, 2, -40}, 1e-4 * Eigen::Matrix3d::Identity()}), 1, 1e-12);
  }
}

}  // namespace
}  // namespace anchord
