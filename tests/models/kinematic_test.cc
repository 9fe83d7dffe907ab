#include "models/kinematic.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Both sides are a few products of well-conditioned matrices of at most 6 x 6.
constexpr double kRounding = 1e-10;

/// The same density as one vector and one matrix over position and velocity.
struct Dense {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

Dense dense(const Kinematic& s, int d) {
  Dense out{Eigen::VectorXd(2 * d), Eigen::MatrixXd(2 * d, 2 * d)};
  out.mean << s.position.head(d), s.velocity.head(d);
  out.covariance << s.pp.topLeftCorner(d, d), s.pv.topLeftCorner(d, d),
      s.pv.topLeftCorner(d, d).transpose(), s.vv.topLeftCorner(d, d);
  return out;
}

Eigen::MatrixXd random_covariance(Dice& dice, int n) {
  Eigen::MatrixXd a(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) a(i, j) = dice.normal();
  return a * a.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

Kinematic random_state(Dice& dice, int d) {
  Kinematic s;
  const Eigen::MatrixXd p = random_covariance(dice, 2 * d);
  s.pp.topLeftCorner(d, d) = p.topLeftCorner(d, d);
  s.pv.topLeftCorner(d, d) = p.topRightCorner(d, d);
  s.vv.topLeftCorner(d, d) = p.bottomRightCorner(d, d);
  for (int i = 0; i < d; ++i) s.position[i] = dice.normal(), s.velocity[i] = dice.normal();
  return s;
}

Gaussian random_measurement(Dice& dice, int d) {
  Gaussian z;
  z.covariance.topLeftCorner(d, d) = random_covariance(dice, d);
  for (int i = 0; i < d; ++i) z.mean[i] = 2 * dice.normal();
  return z;
}

class KinematicIn : public testing::TestWithParam<int> {
 protected:
  const int d = GetParam();
  std::mt19937_64 random{7};
  Dice dice{random};
};
INSTANTIATE_TEST_SUITE_P(Dimensions, KinematicIn, testing::Values(2, 3));

TEST_P(KinematicIn, ConstantVelocityEqualsTheDensePrediction) {
  for (int n = 0; n < 100; ++n) {
    Kinematic s = random_state(dice, d);
    const double dt = dice.scale(1e-3, 10), q = dice.scale(1e-3, 10);
    const Dense before = dense(s, d);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(d, d);
    Eigen::MatrixXd f = Eigen::MatrixXd::Identity(2 * d, 2 * d), noise(2 * d, 2 * d);
    f.topRightCorner(d, d) = dt * one;
    noise << dt * dt * dt / 3 * one, dt * dt / 2 * one, dt * dt / 2 * one, dt * one;
    predict_constant_velocity(s, q, dt, d);
    EXPECT_TRUE(dense(s, d).mean.isApprox(f * before.mean, kRounding));
    EXPECT_TRUE(dense(s, d).covariance.isApprox(f * before.covariance * f.transpose() + q * noise,
                                                kRounding));
  }
}

TEST_P(KinematicIn, UpdateEqualsTheTextbookFormula) {
  for (int n = 0; n < 200; ++n) {
    Kinematic s = random_state(dice, d);
    const Gaussian z = random_measurement(dice, d);
    const Dense before = dense(s, d);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(d, 2 * d);
    h.leftCols(d).setIdentity();
    const Eigen::MatrixXd innovation =
        h * before.covariance * h.transpose() + z.covariance.topLeftCorner(d, d);
    const Eigen::MatrixXd gain = before.covariance * h.transpose() * innovation.inverse();
    update(s, z, d);
    EXPECT_TRUE(dense(s, d).mean.isApprox(before.mean + gain * (z.mean.head(d) - h * before.mean),
                                          kRounding));
    EXPECT_TRUE(dense(s, d).covariance.isApprox(
        before.covariance - gain * innovation * gain.transpose(), kRounding));
  }
}

TEST_P(KinematicIn, FitEqualsTheDenseNormalDensity) {
  for (int n = 0; n < 200; ++n) {
    const Kinematic s = random_state(dice, d);
    const Gaussian z = random_measurement(dice, d);
    const Eigen::MatrixXd sum = (s.pp + z.covariance).topLeftCorner(d, d);
    const Eigen::VectorXd e = (z.mean - s.position).head(d);
    const double distance2 = e.dot(sum.inverse() * e);
    const Fit f = fit(s, z, d);
    EXPECT_NEAR(f.distance2, distance2, kRounding * (1 + distance2));
    EXPECT_NEAR(f.log_likelihood,
                -0.5 * (distance2 + std::log((2 * std::numbers::pi * sum).determinant())),
                kRounding * (1 + distance2));
  }
}

/// Over position and velocity together: the least eigenvalue of the correlation matrix.
double least_correlation(const Kinematic& s, int d) {
  const Eigen::MatrixXd p = dense(s, d).covariance;
  const Eigen::VectorXd scale = p.diagonal().cwiseSqrt().cwiseInverse();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scale.asDiagonal() * p * scale.asDiagonal())
      .eigenvalues()
      .minCoeff();
}

TEST_P(KinematicIn, PositionAndVelocityStayPositiveTogether) {
  for (int sequence = 0; sequence < 20; ++sequence) {
    Kinematic s = random_state(dice, d);
    for (int step = 0; step < 300; ++step) {
      predict_constant_velocity(s, 0.1, dice.scale(1e-3, 1e2), d);
      Gaussian z = random_measurement(dice, d);
      z.covariance *= dice.scale(1e-12, 1e6);
      update(s, z, d);
      ASSERT_GT(s.vv.diagonal().head(d).minCoeff(), 0);
      // An exact measurement after a long time leaves the velocity as a difference of almost equal
      // numbers: some hundred ulps of its variance.
      ASSERT_GT(least_correlation(s, d), -1e-13) << "sequence " << sequence << ", step " << step;
    }
  }
}

TEST(Kinematic, WhatLiesBeyondTwoDimensionsStaysZero) {
  const int d = 2;
  std::mt19937_64 random(8);
  Dice dice(random);
  Kinematic s = random_state(dice, d);
  predict_constant_velocity(s, 0.1, 2, d);
  predict_constant_position(s, 0.1, 2, d);
  update(s, random_measurement(dice, d), d);
  keep_above(s, 10, d);
  EXPECT_EQ(s.position.z(), 0);
  EXPECT_EQ(s.velocity.z(), 0);
  for (const Eigen::Matrix3d* m : {&s.pp, &s.pv, &s.vv}) {
    EXPECT_TRUE(m->row(2).isZero(0));
    EXPECT_TRUE(m->col(2).isZero(0));
  }
}

TEST_P(KinematicIn, KeepAboveRaisesSmallEigenvaluesAndNoOthers) {
  for (int n = 0; n < 100; ++n) {
    Kinematic s = random_state(dice, d);
    const double floor = dice.scale(0.01, 10);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> before(s.pp.topLeftCorner(d, d));
    keep_above(s, floor, d);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> after(s.pp.topLeftCorner(d, d));
    // The closed form for 3 x 3 loses half of the digits where eigenvalues are close.
    EXPECT_TRUE(after.eigenvalues().isApprox(before.eigenvalues().cwiseMax(floor), 1e-7));
    EXPECT_TRUE(
        Eigen::MatrixXd(s.pp.topLeftCorner(d, d))
            .isApprox(before.eigenvectors() * before.eigenvalues().cwiseMax(floor).asDiagonal() *
                          before.eigenvectors().transpose(),
                      1e-7));
  }
}

TEST_P(KinematicIn, KeepAboveZeroChangesNothing) {
  Kinematic s = random_state(dice, d);
  const Eigen::Matrix3d before = s.pp;
  keep_above(s, 0, d);
  EXPECT_EQ(s.pp, before);
}

TEST_P(KinematicIn, MergeKeepsTheVelocityToo) {
  for (int n = 0; n < 100; ++n) {
    const Kinematic a = random_state(dice, d), b = random_state(dice, d);
    const double u = dice.uniform(0.01, 0.99);
    const Dense x = dense(a, d), y = dense(b, d), m = dense(merge(u, a, 1 - u, b), d);
    const Eigen::VectorXd mean = u * x.mean + (1 - u) * y.mean;
    EXPECT_TRUE(m.mean.isApprox(mean, kRounding));
    EXPECT_TRUE(m.covariance.isApprox(
        u * (x.covariance + (x.mean - mean) * (x.mean - mean).transpose()) +
            (1 - u) * (y.covariance + (y.mean - mean) * (y.mean - mean).transpose()),
        kRounding));
  }
}

}  // namespace
}  // namespace anchord
