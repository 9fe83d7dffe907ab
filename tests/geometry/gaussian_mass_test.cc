#include "geometry/gaussian_mass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/geometry/sampling.h"

namespace anchord {
namespace {

/// Room for rounding in a sum of a few terms of order 1.
constexpr double kRounding = 1e-13;
/// What gaussian_mass.h promises for the integral over z.
constexpr double kQuadrature = 1e-9;

double phi(double a, double b) {
  return (std::erf(b / std::sqrt(2)) - std::erf(a / std::sqrt(2))) / 2;
}

Gaussian diagonal(const Eigen::Vector3d& mean, const Eigen::Vector3d& sigma) {
  return {mean, sigma.cwiseAbs2().asDiagonal()};
}

const Region kL{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1.5};

TEST(Mass, OfABoxIsTheProductOverTheAxes) {
  Sampler sampler(1);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d mean(sampler.uniform(-3, 3), sampler.uniform(-3, 3),
                               sampler.uniform(-3, 3));
    const Eigen::Vector3d sigma(sampler.uniform(0.01, 3), sampler.uniform(0.01, 3),
                                sampler.uniform(0.01, 3));
    const Eigen::Vector3d low(-1, -0.5, -2), high(0.7, 2, 0.3);
    Eigen::Vector3d part;
    for (int a = 0; a < 3; ++a)
      part[a] = phi((low[a] - mean[a]) / sigma[a], (high[a] - mean[a]) / sigma[a]);
    EXPECT_NEAR(mass(diagonal(mean, sigma), box(low, high), 2), part[0] * part[1], kRounding);
    EXPECT_NEAR(mass(diagonal(mean, sigma), box(low, high), 3), part.prod(), kRounding);
  }
}

TEST(Mass, OfAHalfPlaneIsTheNormalDistribution) {
  Sampler sampler(2);
  for (int i = 0; i < 200; ++i) {
    const Gaussian density{{0.3, -0.2, 0}, sampler.covariance(0.05, 2, 2)};
    // Corners up to 1e3 / 0.05 standard deviations out round by 4e-12 of one.
    const double edge = sampler.uniform(-3, 3), far = 1e3;
    const double sigma = std::sqrt(density.covariance(0, 0));
    EXPECT_NEAR(mass(density, box({edge, -far, 0}, {far, far, 0}), 2),
                phi((edge - 0.3) / sigma, 1e3), 1e-11);
  }
}

TEST(Mass, FromASplitRegionAddsUp) {
  Sampler sampler(3);
  for (int i = 0; i < 200; ++i) {
    const int dims = i % 2 ? 2 : 3;
    const Gaussian density{{sampler.uniform(-1, 3), sampler.uniform(-1, 3), sampler.uniform(0, 2)},
                           sampler.covariance(0.02, 2, dims)};
    const Region lower{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0, 1.5};
    const Region upper{{{0, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1.5};
    EXPECT_NEAR(mass(density, kL, dims), mass(density, lower, dims) + mass(density, upper, dims),
                3 * kQuadrature);
    Region floor = kL, ceiling = kL;
    floor.z_max = ceiling.z_min = 0.6;
    EXPECT_NEAR(mass(density, kL, 3), mass(density, floor, 3) + mass(density, ceiling, 3),
                3 * kQuadrature);
  }
}

TEST(Mass, DoesNotDependOnTheOrientationOrTheFirstCorner) {
  const Gaussian density{{1, 1, 0.2}, Sampler(4).covariance(0.3, 1, 3)};
  Region other = kL;
  std::reverse(other.polygon.begin(), other.polygon.end());
  EXPECT_NEAR(mass(density, kL, 2), mass(density, other, 2), kRounding);
  std::rotate(other.polygon.begin(), other.polygon.begin() + 2, other.polygon.end());
  EXPECT_NEAR(mass(density, kL, 2), mass(density, other, 2), kRounding);
}

TEST(Mass, AgreesWithSampling) {
  Sampler sampler(5);
  for (int i = 0; i < 60; ++i) {
    const int dims = i % 2 ? 2 : 3;
    const Gaussian density{{sampler.uniform(-1, 3), sampler.uniform(-1, 3), sampler.uniform(0, 2)},
                           sampler.covariance(0.02, 2, dims)};
    const Share share = sampled_share(
        sampler, density, 40'000, [&](const Eigen::Vector3d& p) { return kL.contains(p, dims); });
    // 4.5 standard errors: 60 comparisons exceed it once in 2000 seeds.
    EXPECT_NEAR(mass(density, kL, dims), share.value, 4.5 * share.error) << i;
  }
}

TEST(Mass, OfAStickThroughATableTopIsFound) {
  // sigma 100 m along (1, 0, 1), 1 mm across: the table holds 2 m of it, 2 / sqrt(2) m along x.
  const Eigen::Vector3d along = Eigen::Vector3d(1, 0, 1).normalized();
  Gaussian density;
  density.covariance = 1e4 * along * along.transpose() + 1e-6 * Eigen::Matrix3d::Identity();
  density.mean = {-30, 0, -30};
  const Region table{{{0, -1}, {1, -1}, {1, 1}, {0, 1}}, -5, 5};
  const double from = 30 * std::sqrt(2) / 100, to = 31 * std::sqrt(2) / 100;
  EXPECT_NEAR(mass(density, table, 3), phi(from, to), 1e-7);  // (1 mm / 100 m)^2 is left out
}

TEST(Mass, IsExactlyOneInsideAndZeroOutside) {
  const Gaussian inside = diagonal({0.5, 0.5, 0.7}, {0.01, 0.01, 0.01});
  EXPECT_DOUBLE_EQ(mass(inside, kL, 2), 1);
  EXPECT_DOUBLE_EQ(mass(inside, kL, 3), 1);
  EXPECT_EQ(mass(diagonal({5, 5, 0.7}, {0.1, 0.1, 0.1}), kL, 2), 0);
  EXPECT_EQ(mass(diagonal({0.5, 0.5, 9}, {0.1, 0.1, 0.1}), kL, 3), 0);
  EXPECT_NEAR(mass(diagonal({1.5, 1.5, 0.7}, {0.01, 0.01, 0.01}), kL, 2), 0, kRounding);
}

TEST(Mass, OfASingularCovarianceIsItsLimit) {
  const Gaussian in{{0.5, 1.5, 0.5}, Eigen::Matrix3d::Zero()};
  const Gaussian out{{1.5, 1.5, 0.5}, Eigen::Matrix3d::Zero()};
  for (int dims : {2, 3}) {
    EXPECT_NEAR(mass(in, kL, dims), 1, kRounding);
    EXPECT_NEAR(mass(out, kL, dims), 0, kRounding);
  }
  // A line: along x, and one that climbs with x.
  EXPECT_NEAR(mass(diagonal({1, 1.5, 0.5}, {1, 0, 0}), kL, 2), phi(-1, 0), 1e-8);
  Gaussian climbing{{1, 0.5, 1}, Eigen::Matrix3d::Zero()};
  climbing.covariance << 1, 0, 1, 0, 0, 0, 1, 0, 1;
  EXPECT_NEAR(mass(climbing, kL, 3), phi(-1, 0.5), 1e-6);  // the edge is 1e-7 of a sigma wide
}

}  // namespace
}  // namespace anchord
