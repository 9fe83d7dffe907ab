#include "maintenance/entropy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/quadrature.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

Kinematic bell(double x, double y, double a, double b, double c) {
  Kinematic state;
  state.position = {x, y, 0};
  state.pp(0, 0) = a;
  state.pp(1, 1) = b;
  state.pp(0, 1) = state.pp(1, 0) = c;
  return state;
}

double density(const Kinematic& g, double x, double y) {
  const double a = g.pp(0, 0), b = g.pp(1, 1), c = g.pp(0, 1), det = a * b - c * c;
  const double dx = x - g.position.x(), dy = y - g.position.y();
  return std::exp(-0.5 * (b * dx * dx - 2 * c * dx * dy + a * dy * dy) / det) /
         (2 * std::numbers::pi * std::sqrt(det));
}

/// -integral of p ln p over the square [-20, 20]^2, which holds all of the bells of these tests.
template <typename Density>
double by_quadrature(const Density& p) {
  const auto row = [&](double y) {
    return integrate(
        [&](double x) {
          const double value = p(x, y);
          return value > 0 ? -value * std::log(value) : 0.0;
        },
        -20, 20, 1e-7, 20);
  };
  return integrate(row, -20, 20, 1e-6, 20);
}

TEST(Entropy, OfOneGaussianIsItsIntegral) {
  const Kinematic g = bell(1, -2, 0.5, 2, 0.4);
  // 1e-4: the tolerance of the quadrature, over its 40 m.
  EXPECT_NEAR(gaussian_entropy(g.pp, 2),
              by_quadrature([&](double x, double y) { return density(g, x, y); }), 1e-4);
}

TEST(Entropy, OfASolidGaussianIsTheSumOverItsAxes) {
  const double per_axis = 0.5 * std::log(2 * std::numbers::pi * std::numbers::e);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.1, 2, 30).asDiagonal();
  EXPECT_NEAR(gaussian_entropy(covariance, 3), 3 * per_axis + 0.5 * std::log(6.0), 1e-12);
}

TEST(Entropy, OfMixturesIsBoundedFromAboveAndExactForFarComponents) {
  for (const double apart : {0.0, 0.5, 1.0, 2.0, 4.0, 10.0}) {
    const Kinematic a = bell(-apart / 2, 0, 0.5, 0.5, 0), b = bell(apart / 2, 0, 0.3, 0.8, 0.1);
    Leaf leaf;
    leaf.models = {{0.7, a}, {0.3, b}};
    const double truth = by_quadrature(
        [&](double x, double y) { return 0.7 * density(a, x, y) + 0.3 * density(b, x, y); });
    const double bound = position_entropy(leaf, 2);
    EXPECT_GE(bound, truth - 1e-4) << apart;
    // The worse of both bounds is off by no more than the entropy of the weights.
    EXPECT_LE(bound, truth + binary_entropy(0.3)) << apart;
    if (apart == 10) {
      EXPECT_NEAR(bound, truth, 1e-3);  // overlap of e^-12
    }
  }
}

TEST(Entropy, SomewhereIsExactBeforeAndAfterALook) {
  const Background background(room());
  Somewhere somewhere(background.footprint(-1));
  EXPECT_NEAR(somewhere.entropy(), std::log(100.0), 1e-12);  // uniform over 10 x 10 m
  const Footprint& cells = *somewhere.footprint();
  std::vector<double> left_half;
  for (const Gaussian& cell : cells.moments) left_half.push_back(cell.mean.x() < 5 ? 1 : 0);
  somewhere.miss(0.8, {left_half, cells});
  // Half of the room keeps 0.2 of its mass: 1/6 against 5/6 over 50 m^2 each.
  const double expected = binary_entropy(1.0 / 6) + std::log(50.0);
  EXPECT_NEAR(somewhere.entropy(), expected, 1e-9);
}

TEST(Entropy, DiscreteOnesAreTheTextbooks) {
  EXPECT_NEAR(discrete_entropy(std::vector<double>{0.25, 0.25, 0.25, 0.25}), std::log(4.0), 1e-15);
  EXPECT_EQ(discrete_entropy(std::vector<double>{0, 1}), 0);
  EXPECT_NEAR(binary_entropy(0.5), std::log(2.0), 1e-15);
  EXPECT_EQ(binary_entropy(1), 0);
}

TEST(Entropy, OfABeliefCountsExistenceAndPosition) {
  World world(room());
  ASSERT_TRUE(world.apply(cups_at({{2, 2}, {8, 8}}, kStart)).ok());
  const auto objects = read_objects(*world.belief(), kStart, 0, *world.background());
  ASSERT_EQ(objects.size(), 2u);
  double sum = 0;
  for (const ObjectBelief& object : objects) {
    const double p = object.p;
    const double position = gaussian_entropy(Eigen::Vector3d(0.01, 0.01, 0).asDiagonal(), 2);
    EXPECT_NEAR(entropy(object, *world.background()), binary_entropy(p) + p * position, 1e-9);
    sum += binary_entropy(p) + p * position;
  }
  const BeliefEntropy whole = entropy(*world.belief(), kStart, 0, *world.background());
  EXPECT_NEAR(whole.sum, sum, 1e-9);
  EXPECT_NEAR(whole.max, sum / 2, 1e-9);  // both alike
  EXPECT_EQ(whole.objects, 2);
}

}  // namespace
}  // namespace anchord
