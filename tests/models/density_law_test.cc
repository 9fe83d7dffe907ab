// Laws that every density of a behaviour model keeps, in 2-D and 3-D worlds.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <memory>
#include <random>

#include "models/kinematic.h"
#include "models/somewhere.h"
#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Sums of at most some hundred terms of the size of the result.
constexpr double kRounding = 1e-11;

template <int D>
Gaussian random_measurement(Dice& dice, double least_variance, double most_variance) {
  Gaussian z;
  Eigen::Matrix<double, D, D> basis, spread = Eigen::Matrix<double, D, D>::Zero();
  for (int i = 0; i < D; ++i) {
    z.mean[i] = dice.uniform(0.2, 1.8);
    spread(i, i) = dice.scale(least_variance, most_variance);
    for (int j = 0; j < D; ++j) basis(i, j) = dice.normal();
  }
  const Eigen::Matrix<double, D, D> turn =
      Eigen::HouseholderQR<decltype(basis)>(basis).householderQ();
  const Eigen::Matrix<double, D, D> r = turn * spread * turn.transpose();
  z.covariance.topLeftCorner<D, D>() = 0.5 * (r + r.transpose());
  return z;
}

template <int D>
struct ConstantPosition {
  static constexpr int kDims = D;
  using State = Kinematic;
  static State random(Dice& dice) {
    return kinematic_at(random_measurement<D>(dice, 1e-3, 1), 0, D);
  }
  static void predict(State& s, double dt) { predict_constant_position(s, 0.02, dt, D); }
  static void observe(State& s, Dice& dice) {
    // What a double can tell from a singular matrix: its axes differ by a factor of 1000 at most.
    const double least = dice.scale(1e-12, 1);
    update(s, random_measurement<D>(dice, least, 1e6 * least), D);
  }
  static State merged(double a, const State& x, double b, const State& y) {
    return merge(a, x, b, y);
  }
  static Gaussian moments(const State& s) { return s.position_density(); }
};

template <int D>
struct ConstantVelocity : ConstantPosition<D> {
  static Kinematic random(Dice& dice) {
    Kinematic s = kinematic_at(random_measurement<D>(dice, 1e-3, 1), 0.3, D);
    predict(s, dice.scale(0.01, 10));
    update(s, random_measurement<D>(dice, 1e-3, 1), D);
    return s;
  }
  static void predict(Kinematic& s, double dt) { predict_constant_velocity(s, 0.1, dt, D); }
};

/// Beside a tracked model from which it is entered at 0.3 /s.
template <int D>
struct SomewhereDensity {
  static constexpr int kDims = D;
  struct State {
    double weight;
    Somewhere density;
  };
  static std::shared_ptr<const Footprint> place() {
    // An L whose edges follow no cell's.
    static const auto footprint = std::make_shared<const Footprint>(Footprint::of(
        Region{{{0.1, 0.1}, {1.9, 0.1}, {1.9, 0.8}, {0.9, 0.8}, {0.9, 1.9}, {0.1, 1.9}}, 0.4, 1.2},
        Grid::over(Eigen::Vector3d::Zero(), {2, 2, 2}, 0.25), D));
    return footprint;
  }
  static State random(Dice& dice) {
    State s{0, Somewhere(place())};
    for (int i = 0; i < 3; ++i) predict(s, dice.uniform(0.1, 1)), observe(s, dice);
    return s;
  }
  static void predict(State& s, double dt) {
    const double entering = (1 - s.weight) * -std::expm1(-0.3 * dt);
    if (entering <= 0) return;
    s.density.enter(s.weight, entering);
    s.weight += entering;
  }
  static void observe(State& s, Dice& dice) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < place()->cells.size(); ++i)
      shares.push_back(dice.chance(0.3) ? dice.uniform(0, 1) : dice.chance(0.5) ? 1 : 0);
    const CellShares visible(shares, *place());
    const double p = dice.uniform(0, 0.99), seen = s.density.mass(visible);
    s.density.miss(p, visible);
    s.weight *= (1 - p * seen) / (1 - s.weight * p * seen);
  }
  static State merged(double a, const State& x, double b, const State& y) {
    return {(a * x.weight + b * y.weight) / (a + b), Somewhere::merge(a, x.density, b, y.density)};
  }
  static Gaussian moments(const State& s) { return s.density.moments(); }
};

template <typename Model>
struct DensityLaw : testing::Test {
  static constexpr int kDims = Model::kDims;
  using Square = Eigen::Matrix<double, kDims, kDims>;
  std::mt19937_64 random{20140601};
  Dice dice{random};

  static Square covariance(const typename Model::State& s) {
    return Model::moments(s).covariance.template topLeftCorner<kDims, kDims>();
  }
  static void expect_same(const typename Model::State& a, const typename Model::State& b) {
    const Gaussian x = Model::moments(a), y = Model::moments(b);
    EXPECT_TRUE(x.mean.isApprox(y.mean, kRounding)) << x.mean << "\n" << y.mean;
    EXPECT_TRUE(x.covariance.isApprox(y.covariance, kRounding));
  }
};

using Models = testing::Types<ConstantPosition<2>, ConstantPosition<3>, ConstantVelocity<2>,
                              ConstantVelocity<3>, SomewhereDensity<2>, SomewhereDensity<3>>;
TYPED_TEST_SUITE(DensityLaw, Models);

TYPED_TEST(DensityLaw, TwoPredictionsEqualOneLongOne) {
  for (int n = 0; n < 200; ++n) {
    const auto start = TypeParam::random(this->dice);
    const double dt = this->dice.scale(1e-3, 1e2), part = this->dice.uniform(0, 1);
    auto once = start, twice = start;
    TypeParam::predict(once, dt);
    TypeParam::predict(twice, part * dt);
    TypeParam::predict(twice, dt - part * dt);
    this->expect_same(once, twice);
  }
}

TYPED_TEST(DensityLaw, PredictionOverNoTimeChangesNothing) {
  auto state = TypeParam::random(this->dice);
  const Gaussian before = TypeParam::moments(state);
  TypeParam::predict(state, 0);
  EXPECT_EQ(TypeParam::moments(state).mean, before.mean);
  EXPECT_EQ(TypeParam::moments(state).covariance, before.covariance);
}

TYPED_TEST(DensityLaw, CovarianceStaysSymmetricPositiveDefinite) {
  for (int sequence = 0; sequence < 20; ++sequence) {
    auto state = TypeParam::random(this->dice);
    for (int step = 0; step < 300; ++step) {
      if (this->dice.chance(0.6)) TypeParam::predict(state, this->dice.scale(1e-4, 1e3));
      if (this->dice.chance(0.7)) TypeParam::observe(state, this->dice);
      if (this->dice.chance(0.1))
        state =
            TypeParam::merged(this->dice.scale(1e-9, 1), state, 0.1, TypeParam::random(this->dice));
      const auto c = this->covariance(state);
      ASSERT_TRUE(c.allFinite());
      // Half an ulp: the compiler may sum c and its transpose in another order.
      ASSERT_TRUE(c.isApprox(c.transpose(), 1e-15)) << c;
      ASSERT_EQ(c.llt().info(), Eigen::Success)
          << "sequence " << sequence << ", step " << step << "\n"
          << c;
    }
  }
}

TYPED_TEST(DensityLaw, MergeKeepsMeanAndCovarianceOfTheMixture) {
  for (int n = 0; n < 200; ++n) {
    const auto a = TypeParam::random(this->dice), b = TypeParam::random(this->dice);
    const double weight_a = this->dice.scale(1e-6, 1e3), weight_b = this->dice.scale(1e-6, 1e3);
    const double u = weight_a / (weight_a + weight_b), v = weight_b / (weight_a + weight_b);
    const Gaussian x = TypeParam::moments(a), y = TypeParam::moments(b);
    const Gaussian m = TypeParam::moments(TypeParam::merged(weight_a, a, weight_b, b));
    const Eigen::Vector3d mean = u * x.mean + v * y.mean;
    const Eigen::Matrix3d second = u * (x.covariance + x.mean * x.mean.transpose()) +
                                   v * (y.covariance + y.mean * y.mean.transpose());
    EXPECT_TRUE(m.mean.isApprox(mean, kRounding));
    EXPECT_TRUE((m.covariance + mean * mean.transpose()).isApprox(second, kRounding));
  }
}

TYPED_TEST(DensityLaw, MergeDoesNotDependOnTheOrder) {
  for (int n = 0; n < 50; ++n) {
    const auto a = TypeParam::random(this->dice), b = TypeParam::random(this->dice);
    const double weight_a = this->dice.scale(1e-3, 1), weight_b = this->dice.scale(1e-3, 1);
    this->expect_same(TypeParam::merged(weight_a, a, weight_b, b),
                      TypeParam::merged(weight_b, b, weight_a, a));
  }
}

TYPED_TEST(DensityLaw, MergeWithItselfChangesNothing) {
  const auto a = TypeParam::random(this->dice);
  this->expect_same(TypeParam::merged(0.3, a, 2, a), a);
}

TYPED_TEST(DensityLaw, CopiesDoNotShareWhatChanges) {
  const auto original = TypeParam::random(this->dice);
  const Gaussian before = TypeParam::moments(original);
  auto copy = original;
  TypeParam::predict(copy, 3);
  TypeParam::observe(copy, this->dice);
  EXPECT_NE(TypeParam::moments(copy).covariance, before.covariance);
  EXPECT_EQ(TypeParam::moments(original).mean, before.mean);
  EXPECT_EQ(TypeParam::moments(original).covariance, before.covariance);
}

}  // namespace
}  // namespace anchord
