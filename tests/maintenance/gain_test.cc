#include "maintenance/gain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maintenance/entropy.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

constexpr double kNoise = 0.01;  // of the room's eye, m^2
// Sums of a few logarithms of numbers of order 1.
constexpr double kRounding = 1e-9;

/// The robot stands 1 m from the origin of the cups, at (5, 5).
BasePose near() { return {{4, 5}, 0, 0}; }

TEST(Gain, OneSureLookAtOneGaussianIsTheClosedForm) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  const double variance = 0.5, psd = 0.02, t = 10;
  const std::vector<Subject> subjects{with_q(cup("c", 5, 5, variance, knowledge, psd), 1)};
  const double before = variance + psd * t, after = before * kNoise / (before + kNoise);
  // Two axes, each 1/2 ln(P / P').
  EXPECT_NEAR(expected_gain(subjects, {{0, near(), t}}, t, site), std::log(before / after),
              kRounding);
  // Later: both have grown.
  EXPECT_NEAR(expected_gain(subjects, {{0, near(), t}}, t + 30, site),
              std::log((before + psd * 30) / (after + psd * 30)), kRounding);
}

TEST(Gain, ALookThatMayMissCountsItsProbability) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  const std::vector<Subject> subjects{with_q(cup("c", 5, 5, 0.5, knowledge), 0.7)};
  const double after = 0.5 * kNoise / (0.5 + kNoise);
  EXPECT_NEAR(expected_gain(subjects, {{0, near(), 0}}, 0, site), 0.7 * std::log(0.5 / after),
              kRounding);
}

TEST(Gain, ALookDecidesAboutExistence) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  const double p = 0.6, q = 0.7, variance = 0.5;
  const std::vector<Subject> subjects{with_q(cup("c", 5, 5, variance, knowledge, 0, p), q)};
  const double after = variance * kNoise / (variance + kNoise);
  const auto h = [](double v) {
    return gaussian_entropy(Eigen::Vector3d(v, v, 0).asDiagonal(), 2);
  };
  const double missed = p * (1 - q) / (1 - p * q);
  const double without = binary_entropy(p) + p * h(variance);
  const double with =
      p * q * h(after) + (1 - p * q) * (binary_entropy(missed) + missed * h(variance));
  EXPECT_NEAR(expected_gain(subjects, {{0, near(), 0}}, 0, site), without - with, kRounding);
}

TEST(Gain, SureLooksEqualAKalmanFilter) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  const double psd = 0.02;
  const std::vector<Subject> subjects{with_q(cup("c", 5, 5, 0.5, knowledge, psd), 1)};
  std::vector<Glance> looks;
  double variance = 0.5;
  for (int k = 1; k <= 20; ++k) {
    looks.push_back({0, near(), 0.5 * k});
    variance += psd * 0.5;
    variance = variance * kNoise / (variance + kNoise);
  }
  const double without = 0.5 + psd * 10;
  EXPECT_NEAR(expected_gain(subjects, looks, 10, site), std::log(without / variance), kRounding);
}

TEST(Gain, AMovingObjectIsAKalmanFilterOfPositionAndVelocity) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  Subject subject = with_q(cup("c", 5, 5, 0.5, knowledge), 1);
  Subject::Track& track = subject.tracks.front();
  track.moves = true;
  track.psd = 0.1;
  track.state.vv(0, 0) = track.state.vv(1, 1) = 0.3;
  Kinematic seen = track.state, free = track.state;
  std::vector<Glance> looks;
  Gaussian measurement;
  measurement.mean = {5, 5, 0};
  measurement.covariance = Eigen::Vector3d(kNoise, kNoise, 0).asDiagonal();
  for (int k = 1; k <= 5; ++k) {
    looks.push_back({0, near(), 0.4 * k});
    predict_constant_velocity(seen, 0.1, 0.4, 2);
    update(seen, measurement, 2);
  }
  predict_constant_velocity(free, 0.1, 2, 2);
  EXPECT_NEAR(expected_gain({subject}, looks, 2, site),
              gaussian_entropy(free.pp, 2) - gaussian_entropy(seen.pp, 2), kRounding);
}

TEST(Gain, TwoSensorsFuse) {
  RoomOptions options;
  options.more_sensors = R"(, "far": {"view": {"type": "sector", "range": [0, 6],
    "bearing": [-3, 3]}, "noise": [0.09, 0, 0, 0.04], "verification": {}})";
  const Knowledge knowledge = room(options);
  const Site site(knowledge);
  ASSERT_EQ(site.eyes.size(), 2u);
  const int eye = site.sensor_names[0] == "eye" ? 0 : 1;
  const std::vector<Subject> subjects{with_q(cup("c", 5, 5, 0.5, knowledge, 0), 1)};
  const double x = 1 / (1 / 0.5 + 1 / kNoise + 1 / 0.09);
  const double y = 1 / (1 / 0.5 + 1 / kNoise + 1 / 0.04);
  EXPECT_NEAR(expected_gain(subjects, {{eye, near(), 0}, {1 - eye, near(), 1}}, 1, site),
              0.5 * std::log(0.25 / (x * y)), kRounding);
  // Turned by a quarter the far one's noise changes its axes.
  const BasePose turned{{5, 4}, 1.5707963267948966, 0};
  const double across = 1 / (1 / 0.5 + 1 / 0.04), along = 1 / (1 / 0.5 + 1 / 0.09);
  Forecast forecast(subjects, site);
  forecast.look({1 - eye, turned, 0});
  EXPECT_NEAR(forecast.gain(0), 0.5 * std::log(0.25 / (across * along)), kRounding);
}

TEST(Gain, WhatIsOutOfViewOrBehindAWallGainsNothing) {
  RoomOptions options;
  options.walls = "[[[4.5, 0], [4.5, 10]]]";
  const Knowledge knowledge = room(options);
  const Site site(knowledge), open{room()};
  const std::vector<Subject> subjects{cup("c", 5, 5, 0.5, knowledge)};
  EXPECT_EQ(expected_gain(subjects, {{0, near(), 0}}, 0, site), 0);
  EXPECT_GT(expected_gain(subjects, {{0, near(), 0}}, 0, open), 1);
  EXPECT_EQ(expected_gain(subjects, {{0, {{1, 5}, 0, 0}, 0}}, 0, open), 0);    // too far
  EXPECT_EQ(expected_gain(subjects, {{0, {{4.9, 5}, 0, 0}, 0}}, 0, open), 0);  // too near
}

TEST(Gain, ASeenSomewhereIsFoundOrLessLikelyThere) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  Subject subject = cup("c", 0, 0, 0.5, knowledge);
  subject.tracks.clear();
  // Two halves of a place, of which one is in view.
  subject.tiles = {{0.5, {5, 5, 0}, 4}, {0.5, {9, 9, 0}, 4}};
  const double q = 0.8,
               noise = gaussian_entropy(Eigen::Vector3d(kNoise, kNoise, 0).asDiagonal(), 2);
  const double without = std::log(8.0), missed = 1 - 0.5 * q;
  const double with = 0.5 * q * noise + missed * (binary_entropy(0.5 / missed) + std::log(4.0));
  EXPECT_NEAR(expected_gain({with_q(subject, q)}, {{0, near(), 0}}, 0, site), without - with,
              kRounding);
}

TEST(Gain, ALeakGrowsTheEntropyThatALookTakesAway) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  Subject subject = with_q(cup("c", 5, 5, 0.5, knowledge, 0), 1);
  subject.tracks.front().leak = 0.1;
  subject.lost_entropy = std::log(100.0);
  const std::vector<Subject> subjects{subject};
  const Forecast forecast(subjects, site);
  const double stays = std::exp(-0.1 * 5);
  const double h = gaussian_entropy(Eigen::Vector3d(0.5, 0.5, 0).asDiagonal(), 2);
  EXPECT_NEAR(forecast.entropies(0, 5).without,
              binary_entropy(stays) + stays * h + (1 - stays) * std::log(100.0), kRounding);
  EXPECT_NEAR(forecast.entropies(0, 5).with, forecast.entropies(0, 5).without, kRounding);
}

TEST(Gain, ResettingForgetsEveryLook) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  const std::vector<Subject> subjects{cup("a", 5, 5, 0.5, knowledge),
                                      cup("b", 5, 6, 0.5, knowledge)};
  Forecast forecast(subjects, site);
  forecast.look({0, near(), 0});
  EXPECT_EQ(forecast.seen().size(), 2u);
  const double gain = forecast.gain(1);
  forecast.reset();
  EXPECT_EQ(forecast.gain(1), 0);
  forecast.look({0, near(), 0});
  EXPECT_EQ(forecast.gain(1), gain);
}

}  // namespace
}  // namespace anchord
