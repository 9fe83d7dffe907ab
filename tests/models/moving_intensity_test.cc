#include "models/moving_intensity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Sums of positive terms of like size, a few thousand of them.
constexpr double kRounding = 1e-11;

auto always(double p) {
  return [p](const Eigen::Vector3d&) { return p; };
}

MapView everything() {
  View view;
  view.type = View::Type::kWorld;
  return *MapView::place(view, std::nullopt, 2);
}

MapView square(double low, double high) {
  View view;
  view.type = View::Type::kPolygon;
  view.points = {{low, low}, {high, low}, {high, high}, {low, high}};
  return *MapView::place(view, std::nullopt, 2);
}

Gaussian spot(double x, double y, double variance) {
  return {{x, y, 0}, Eigen::Vector3d(variance, variance, 0).asDiagonal()};
}

Kinematic density(double x, double y, double variance, double vx, double vy, double vv) {
  Kinematic k = kinematic_at(spot(x, y, variance), vv, 2);
  k.velocity = {vx, vy, 0};
  return k;
}

/// Two doors of a yard, people coming in at them.
MovingArrivals yard() {
  MovingArrivals a;
  a.sources = {{density(0, 0, 1, 0, 0, 2), 0.3, 0.2}, {density(20, 5, 2, -1.5, 0, 0.3), 0.1, 0}};
  a.psd = 0.1;
  a.departure_rate = 0.02;
  a.dims = 2;
  return a;
}

MovingIntensity intensity_of(MovingArrivals arrivals) {
  return MovingIntensity(std::make_shared<const MovingArrivals>(std::move(arrivals)));
}

/// Expected number, and mean and second moment about the origin of the state, times that number.
struct Moments {
  double number = 0;
  Eigen::Vector4d first = Eigen::Vector4d::Zero();
  Eigen::Matrix4d second = Eigen::Matrix4d::Zero();

  void add(double weight, const Kinematic& k) {
    Eigen::Vector4d mean;
    mean << k.position.head<2>(), k.velocity.head<2>();
    Eigen::Matrix4d covariance;
    covariance << k.pp.topLeftCorner<2, 2>(), k.pv.topLeftCorner<2, 2>(),
        k.pv.topLeftCorner<2, 2>().transpose(), k.vv.topLeftCorner<2, 2>();
    number += weight;
    first += weight * mean;
    second += weight * (covariance + mean * mean.transpose());
  }
};

Moments moments(const MovingIntensity& intensity) {
  Moments sum;
  for (const auto& mixture : intensity.mixtures())
    for (const auto& c : mixture) sum.add(c.weight, c.density);
  return sum;
}

void expect_same(const Moments& a, const Moments& b, double tolerance) {
  EXPECT_NEAR(a.number, b.number, tolerance * (1 + b.number));
  EXPECT_LT((a.first - b.first).norm(), tolerance * (1 + b.first.norm()));
  EXPECT_LT((a.second - b.second).norm(), tolerance * (1 + b.second.norm()));
}

/// The same intensity by brute force: one normal density for every short while in which something
/// may have arrived, each on its own.
class ByInstants {
 public:
  ByInstants(MovingArrivals arrivals, double step) : arrivals_(std::move(arrivals)), step_(step) {
    for (const auto& source : arrivals_.sources)
      if (source.at_start > 0) grains_.push_back({source.at_start, source.density});
  }
  void advance(double dt) {
    for (auto& [weight, k] : grains_) move(weight, k, dt);
    const int steps = static_cast<int>(std::lround(dt / step_));
    for (int i = 0; i < steps; ++i)
      for (const auto& source : arrivals_.sources) {
        double weight = source.rate * step_;
        Kinematic k = source.density;
        move(weight, k, (i + 0.5) * step_);
        grains_.push_back({weight, k});
      }
  }
  void miss(const MapView& view, double p) {
    for (auto& [weight, k] : grains_) weight *= 1 - p * view.mass(k.position_density());
  }
  Moments moments() const {
    Moments sum;
    for (const auto& [weight, k] : grains_) sum.add(weight, k);
    return sum;
  }
  Moments found_at(const Gaussian& z) const {
    Moments sum;
    for (auto [weight, k] : grains_) {
      weight *= std::exp(fit(k, z, 2).log_likelihood);
      update(k, z, 2);
      sum.add(weight, k);
    }
    return sum;
  }

 private:
  void move(double& weight, Kinematic& k, double dt) const {
    weight *= std::exp(-arrivals_.departure_rate * dt);
    predict_constant_velocity(k, arrivals_.psd, dt, 2);
  }
  MovingArrivals arrivals_;
  double step_;
  std::vector<std::pair<double, Kinematic>> grains_;
};

TEST(MovingIntensity, HasTheMomentsOfEveryInstantOfArrival) {
  // A midpoint rule: its error is of the order (step / span)^2 = 1e-6.
  for (const double mu : {0.0, 1e-14, 0.02, 0.5}) {
    MovingArrivals arrivals = yard();
    arrivals.departure_rate = mu;
    ByInstants expected(arrivals, 1e-3);
    expected.advance(3);
    MovingIntensity intensity = intensity_of(arrivals);
    intensity.advance(3);
    expect_same(moments(intensity), expected.moments(), 1e-5);
  }
}

TEST(MovingIntensity, ARandomWalkSpreadsToo) {
  MovingArrivals arrivals = yard();
  arrivals.constant_velocity = false;
  arrivals.departure_rate = 0;
  arrivals.sources = {{kinematic_at(spot(1, 2, 0.5), 0, 2), 1, 0}};
  MovingIntensity intensity = intensity_of(arrivals);
  intensity.advance(4);
  const Moments found = moments(intensity);
  EXPECT_NEAR(found.number, 4, kRounding);
  EXPECT_NEAR(found.second(0, 0) / 4 - 1, 0.5 + 0.1 * 2,
              kRounding);  // they came 2 s ago on average
}

TEST(MovingIntensity, TwoStepsAreOneLongOne) {
  std::mt19937_64 random(3);
  Dice dice(random);
  for (int n = 0; n < 50; ++n) {
    MovingArrivals arrivals = yard();
    arrivals.departure_rate = dice.chance(0.3) ? 0 : dice.scale(1e-4, 1);
    const double a = dice.scale(0.01, 30), b = dice.scale(0.01, 30);
    MovingIntensity one = intensity_of(arrivals), two = one;
    one.advance(a + b);
    two.advance(a);
    two.advance(a + b);
    expect_same(two.mixtures().size() ? moments(two) : Moments{}, moments(one), 1e-9);
  }
}

TEST(MovingIntensity, NothingIsLostByMerging) {
  // The number obeys d n / dt = rate - mu n, and each look takes its share, whatever is merged.
  std::mt19937_64 random(4);
  Dice dice(random);
  MovingIntensity intensity = intensity_of(yard());
  double time = 0, expected = 0.2;
  for (int frame = 0; frame < 300; ++frame) {
    const double dt = dice.chance(0.1) ? 0 : dice.scale(0.001, 3), p = dice.uniform(0, 0.99);
    time += dt;
    expected = expected * std::exp(-0.02 * dt) + 0.4 * -std::expm1(-0.02 * dt) / 0.02;
    intensity.advance(time);
    if (frame % 3 == 0) {
      intensity.miss(everything(), always(p));
      expected *= 1 - p;
    }
    ASSERT_NEAR(moments(intensity).number, expected, kRounding * expected);
  }
}

TEST(MovingIntensity, SaysOfADetectionWhatEveryInstantOfArrivalSays) {
  // Merging costs up to 0.01 nats a time (kAlike), and a view's edge is cut through densities as a
  // whole: a few per cent where there is anything to speak of.
  constexpr double kMerged = 0.05;
  std::mt19937_64 random(5);
  Dice dice(random);
  for (int n = 0; n < 10; ++n) {
    ByInstants expected(yard(), 0.02);
    MovingIntensity intensity = intensity_of(yard());
    double time = 0;
    for (int frame = 0; frame < 12; ++frame) {
      const double dt = 0.02 * dice.integer(0, 100);
      time += dt;
      expected.advance(dt);
      intensity.advance(time);
      const MapView view = dice.chance(0.5) ? everything() : square(-30, 12);
      const double p = dice.uniform(0.1, 0.9);
      expected.miss(view, p);
      intensity.miss(view, always(p));
    }
    for (int k = 0; k < 20; ++k) {
      const Gaussian z = spot(dice.uniform(-5, 22), dice.uniform(-4, 8), 0.3);
      const Moments m = expected.found_at(z);
      if (m.number < 1e-6) continue;  // expected objects per m^2: the tails of tails
      EXPECT_NEAR(intensity.intensity(z) / m.number, 1, kMerged) << z.mean.transpose();
      const Kinematic found = intensity.found_at(z, 0, {});
      const Eigen::Vector4d mean = m.first / m.number;
      const Eigen::Matrix4d covariance = m.second / m.number - mean * mean.transpose();
      for (int i = 0; i < 2; ++i) {
        const double sigma = std::sqrt(covariance(i, i)),
                     v_sigma = std::sqrt(covariance(i + 2, i + 2));
        EXPECT_NEAR(found.position[i], mean[i], kMerged * sigma);
        EXPECT_NEAR(found.velocity[i], mean[i + 2], 2 * kMerged * v_sigma);
        EXPECT_NEAR(found.pp(i, i) / covariance(i, i), 1, kMerged);
        EXPECT_NEAR(found.vv(i, i) / covariance(i + 2, i + 2), 1, 3 * kMerged);
      }
    }
  }
}

TEST(MovingIntensity, WhatStoodThereCountsByItsWeight) {
  MovingArrivals arrivals = yard();
  arrivals.sources = {{density(0, 0, 1, 0, 0, 2), 0, 0.5}};
  const MovingIntensity intensity = intensity_of(arrivals);
  const Gaussian z = spot(1, 0, 0.25);
  const double met = 0.5 * std::exp(-0.5 / 1.25) / (2 * std::numbers::pi * 1.25);
  EXPECT_NEAR(intensity.intensity(z), met, 1e-15);
  const Kinematic still = kinematic_at(z, 4, 2);
  const double u = met / (met + 0.1);
  const Kinematic found = intensity.found_at(z, 0.1, still);
  EXPECT_NEAR(found.position.x(), u * 0.8 + (1 - u) * 1, 1e-14);  // gain 1 / 1.25
  EXPECT_NEAR(found.vv(0, 0), u * 2 + (1 - u) * 4, 1e-14);
  EXPECT_NEAR(found.pp(1, 1), u * 0.2 + (1 - u) * 0.25, 1e-14);
}

TEST(MovingIntensity, StaysSmallWhateverHappens) {
  constexpr std::size_t kMost = 32;  // components of a source, as documented in the code
  MovingArrivals arrivals = yard();
  arrivals.sources.push_back({density(0, 0, 0.01, 10, 0, 1e-4), 1, 0});  // all along one line
  arrivals.departure_rate = 0;
  MovingIntensity looked_at = intensity_of(arrivals), left_alone = looked_at;
  left_alone.advance(86400);
  for (int i = 1; i <= 3000; ++i) {
    looked_at.advance(0.1 * i);
    looked_at.miss(everything(), always(i % 7 == 0 ? 0.9 : 0.01));
  }
  for (const auto* intensity : {&looked_at, &left_alone})
    for (const auto& mixture : intensity->mixtures()) {
      EXPECT_LE(mixture.size(), kMost);
      for (const auto& c : mixture) {
        EXPECT_TRUE(c.density.pp.allFinite());
        EXPECT_GT((c.density.pp.topLeftCorner<2, 2>().determinant()), 0);
      }
    }
  EXPECT_NEAR(moments(left_alone).number, 0.2 + 1.4 * 86400, 1e-6);
}

TEST(MovingIntensity, IsExpectedInARegionByItsMassThere) {
  MovingArrivals arrivals = yard();
  arrivals.sources = {{density(1, 0, 4, 2, 0, 1), 0, 0.5}};
  arrivals.psd = arrivals.departure_rate = 0;
  MovingIntensity intensity = intensity_of(arrivals);
  intensity.advance(3);  // at x = 7, variance 4 + 9
  const Region west{{{-500, -500}, {10, -500}, {10, 500}, {-500, 500}}};
  EXPECT_NEAR(intensity.expected(west), 0.5 * 0.5 * std::erfc(-3 / std::sqrt(2 * 13.0)), 1e-12);
}

TEST(MovingIntensity, CopiesDoNotShareChanges) {
  MovingIntensity intensity = intensity_of(yard());
  intensity.advance(2);
  const MovingIntensity before = intensity;
  const double then = moments(before).number;
  intensity.miss(everything(), always(0.5));
  intensity.advance(5);
  EXPECT_EQ(moments(before).number, then);
}

}  // namespace
}  // namespace anchord
