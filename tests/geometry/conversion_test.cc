#include "geometry/conversion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "tests/geometry/sampling.h"

namespace anchord {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kDegree = kPi / 180;

Matrix3d exponential(const Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle == 0) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Vector3d direction(double bearing, double elevation) {
  return {std::cos(elevation) * std::cos(bearing), std::cos(elevation) * std::sin(bearing),
          std::sin(elevation)};
}

void set_covariance(Pose& pose, const Matrix6d& covariance) {
  for (int i = 0; i < 36; ++i) pose.covariance[i] = covariance(i / 6, i % 6);
}

Matrix3d rotation(const Pose& pose) {
  const auto& q = pose.orientation;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// A pose as it is measured when `truth` is true and the errors (position, small rotations about
/// the map's axes) are `error`: true = error applied to measured.
Pose measured(const Pose& truth, const Eigen::VectorXd& error) {
  const Matrix3d turned_back = exponential(error.tail<3>()).transpose() * rotation(truth);
  const Eigen::Quaterniond q(turned_back);
  Pose pose = truth;
  pose.orientation = {q.w(), q.x(), q.y(), q.z()};
  for (int i = 0; i < 3; ++i) pose.position[i] -= error[i];
  return pose;
}

/// Averages over measurements of one truth, with standard errors.
struct Statistics {
  Vector3d bias = Vector3d::Zero(), bias_error = Vector3d::Zero();
  double nees = 0, nees_error = 0;
};

using Estimator = Result<Gaussian> (*)(const PolarMeasurement&, const std::optional<Pose>&, int);

Statistics simulate(Sampler& sampler, const PolarMeasurement& truth, const Pose& pose,
                    const Matrix6d& pose_covariance, int dims, int count, Estimator estimator) {
  const Vector3d position =
      Vector3d(pose.position.data()) +
      truth.range * (rotation(pose) * direction(truth.bearing, truth.elevation));
  const MatrixXd root = root_of(pose_covariance);
  Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
  double nees_sum = 0, nees_squares = 0;
  for (int i = 0; i < count; ++i) {
    PolarMeasurement z = truth;
    z.range += std::sqrt(truth.variance[0]) * sampler.normal();
    z.bearing += std::sqrt(truth.variance[1]) * sampler.normal();
    if (dims == 3) z.elevation += std::sqrt(truth.variance[2]) * sampler.normal();
    Pose seen = measured(pose, root * sampler.white(6));
    set_covariance(seen, pose_covariance);
    const Gaussian converted = *estimator(z, seen, dims);
    Vector3d error = converted.mean - position;
    if (dims == 2) error.z() = 0;
    sum += error;
    squares += error.cwiseAbs2();
    const auto used = error.head(dims);
    const MatrixXd inverse = converted.covariance.topLeftCorner(dims, dims).inverse();
    const double nees = used.dot(inverse * used);
    nees_sum += nees;
    nees_squares += nees * nees;
  }
  Statistics result;
  result.bias = sum / count;
  result.bias_error = ((squares / count - result.bias.cwiseAbs2()) / count).cwiseMax(0).cwiseSqrt();
  result.nees = nees_sum / count;
  result.nees_error = std::sqrt((nees_squares / count - result.nees * result.nees) / count);
  return result;
}

/// Plain linearisation, to show that the test can tell.
Result<Gaussian> linearised(const PolarMeasurement& z, const std::optional<Pose>&, int) {
  Gaussian result;
  result.mean = z.range * direction(z.bearing, 0);
  Matrix3d jacobian = Matrix3d::Zero();
  jacobian.col(0) = direction(z.bearing, 0);
  jacobian.col(1) = z.range * direction(z.bearing + kPi / 2, 0);
  const Vector3d variance(z.variance[0], z.variance[1], 0);
  result.covariance = jacobian * variance.asDiagonal() * jacobian.transpose();
  return result;
}

/// Thesis figure 6.3: an object at 4 m, 45 degrees, sigma_r = 0.02 m.
PolarMeasurement figure_6_3(double sigma_degrees) {
  PolarMeasurement truth;
  truth.range = 4;
  truth.bearing = 45 * kDegree;
  truth.variance = {0.02 * 0.02, std::pow(sigma_degrees * kDegree, 2), 1e-6};
  return truth;
}

constexpr int kCount = 20'000;

TEST(Conversion, IsUnbiasedAndConsistentForAnyBearingNoise) {
  Sampler sampler(1);
  for (const double sigma : {2, 5, 10, 20}) {
    const Statistics s =
        simulate(sampler, figure_6_3(sigma), {}, Matrix6d::Zero(), 2, kCount, to_map);
    EXPECT_LT(std::abs(s.bias.x()), 4 * s.bias_error.x()) << sigma;
    EXPECT_LT(std::abs(s.bias.y()), 4 * s.bias_error.y()) << sigma;
    EXPECT_NEAR(s.nees, 2, 4 * s.nees_error) << sigma;
  }
}

TEST(Conversion, ByLinearisationWouldNotPassThisTest) {
  Sampler sampler(1);
  const Statistics s =
      simulate(sampler, figure_6_3(20), {}, Matrix6d::Zero(), 2, kCount, linearised);
  EXPECT_GT(s.bias.norm(), 4 * s.bias_error.norm());
  EXPECT_GT(s.nees, 2 + 4 * s.nees_error);
}

TEST(Conversion, IsUnbiasedAndConsistentForAnyHeadingNoise) {
  Sampler sampler(2);
  for (const int dims : {2, 3}) {
    for (const double sigma : {2, 5, 10, 20}) {
      PolarMeasurement truth = figure_6_3(sigma / 2);
      const Pose pose = exact_pose({3, -2, dims == 2 ? 0.0 : 1.0}, turned(1.1, {0, 0, 1}));
      Matrix6d covariance = Matrix6d::Zero();
      covariance(0, 0) = covariance(1, 1) = 0.01;
      covariance(5, 5) = std::pow(sigma * kDegree, 2);
      covariance(0, 5) = covariance(5, 0) = 0.05 * sigma * kDegree;  // correlation 0.5
      const Statistics s = simulate(sampler, truth, pose, covariance, dims, kCount, to_map);
      for (int i = 0; i < dims; ++i)
        EXPECT_LT(std::abs(s.bias[i]), 4 * s.bias_error[i]) << dims << " " << sigma;
      EXPECT_NEAR(s.nees, dims, 4 * s.nees_error) << dims << " " << sigma;
    }
  }
}

TEST(Conversion, IsUnbiasedAndConsistentWithATiltedUncertainPose) {
  Sampler sampler(3);
  PolarMeasurement truth = figure_6_3(10);
  truth.elevation = 0.3;
  truth.variance[2] = std::pow(5 * kDegree, 2);
  const Pose pose = exact_pose({3, -2, 1}, turned(0.8, {1, 2, -1}));
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 0.01, 0.01, 0.01, std::pow(3 * kDegree, 2), std::pow(3 * kDegree, 2),
      std::pow(8 * kDegree, 2);
  const Statistics s = simulate(sampler, truth, pose, covariance, 3, kCount, to_map);
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(s.bias[i]), 4 * s.bias_error[i]);
  // Elevation noise turns the error's axes against the measurement's: within 2 %.
  EXPECT_NEAR(s.nees, 3, 0.06 + 4 * s.nees_error);
}

/// The covariance that the definition gives: truths drawn given one measurement.
TEST(Conversion, HasTheCovarianceOfTheTruthGivenTheMeasurement) {
  Sampler sampler(4);
  for (int n = 0; n < 6; ++n) {
    // Heading alone (exact), then all six with the cross terms (to second order).
    const bool heading_alone = n < 3;
    Matrix6d covariance = Matrix6d::Zero();
    if (heading_alone) {
      covariance(5, 5) = 0.16;
      covariance(0, 0) = 0.04;
      covariance(0, 5) = covariance(5, 0) = 0.06;
    } else {
      Matrix6d factor;
      for (auto& x : factor.reshaped()) x = 0.06 * sampler.normal();
      covariance = factor * factor.transpose();
    }
    Pose pose = exact_pose({1, 2, 3}, sampler.orientation());
    set_covariance(pose, covariance);
    PolarMeasurement z;
    z.range = 3;
    z.bearing = sampler.uniform(-3, 3);
    z.elevation = sampler.uniform(-1, 1);
    z.variance = {0.01, 0.09, 0.04};
    const Gaussian converted = *to_map(z, pose, 3);

    const MatrixXd root = root_of(covariance);
    Matrix3d sum = Matrix3d::Zero(), squares = Matrix3d::Zero();
    const int count = 100'000;
    for (int i = 0; i < count; ++i) {
      const Vector3d p =
          (z.range + 0.1 * sampler.normal()) *
          direction(z.bearing + 0.3 * sampler.normal(), z.elevation + 0.2 * sampler.normal());
      const Eigen::VectorXd error = root * sampler.white(6);
      const Vector3d truth = Vector3d(pose.position.data()) + error.head<3>() +
                             exponential(error.tail<3>()) * rotation(pose) * p;
      const Vector3d off = converted.mean - truth;
      const Matrix3d product = off * off.transpose();
      sum += product;
      squares += product.cwiseAbs2();
    }
    const Matrix3d mean = sum / count;
    const Matrix3d error = ((squares / count - mean.cwiseAbs2()) / count).cwiseSqrt();
    // Beyond second order: range^2 times a few S^2, S about 6 * 0.06^2.
    const double remainder = heading_alone ? 0 : 9 * 2 * std::pow(6 * 0.06 * 0.06, 2);
    for (int i = 0; i < 9; ++i)
      EXPECT_NEAR(converted.covariance(i), mean(i), 4.5 * error(i) + remainder) << n << " " << i;
  }
}

TEST(Conversion, In2DIsThePublishedFormula) {
  // Longbin et al. (1998), equations for R given the measurement; lambda = exp(-var/2).
  const double r = 4, theta = 0.7, var_r = 0.04, var_b = 0.03, var_h = 0.06;
  const double var = var_b + var_h;
  const double lambda = std::exp(-var / 2), twice = std::exp(-2 * var);
  const double c = std::cos(theta), s = std::sin(theta);
  const double second = (r * r + var_r) / 2;
  PolarMeasurement z;
  z.range = r;
  z.bearing = 0.2;
  z.variance = {var_r, var_b, 0};
  Pose pose = exact_pose({0, 0, 7}, turned(0.5, {0, 0, 1}));
  pose.covariance[35] = var_h;
  const Gaussian converted = *to_map(z, pose, 2);
  const double factor = (1 / (lambda * lambda) - 2) * r * r;
  // Rounding in sums of terms of order 16.
  EXPECT_NEAR(converted.mean.x(), r * c / lambda, 1e-13);
  EXPECT_NEAR(converted.mean.y(), r * s / lambda, 1e-13);
  EXPECT_NEAR(converted.covariance(0, 0), factor * c * c + second * (1 + twice * (c * c - s * s)),
              1e-13);
  EXPECT_NEAR(converted.covariance(1, 1), factor * s * s + second * (1 - twice * (c * c - s * s)),
              1e-13);
  EXPECT_NEAR(converted.covariance(0, 1), factor * c * s + second * twice * 2 * c * s, 1e-13);
  EXPECT_EQ(converted.mean.z(), 0);
  EXPECT_EQ(converted.covariance.col(2), Vector3d::Zero());
}

TEST(Conversion, WithoutAngleNoiseIsARotation) {
  Sampler sampler(5);
  for (int i = 0; i < 50; ++i) {
    const Matrix3d noise = sampler.covariance(0.01, 0.02, 3);
    CartesianMeasurement z;
    z.position = {1e4, -3e3, 50};
    z.covariance.assign(noise.data(), noise.data() + 9);
    EXPECT_EQ(to_map(z, {}, 3)->covariance, noise);
    const Pose pose = exact_pose({-500, 20, 1}, sampler.orientation());
    const Gaussian converted = *to_map(z, pose, 3);
    // A few roundings of numbers of order 4e-4, however far the object is.
    const Matrix3d expected = rotation(pose) * noise * rotation(pose).transpose();
    EXPECT_TRUE(converted.covariance.isApprox(expected, 1e-14));
    EXPECT_TRUE(converted.mean.isApprox(
        Vector3d(-500, 20, 1) + rotation(pose) * Vector3d(1e4, -3e3, 50), 1e-14));
  }
}

TEST(Conversion, FarAwayWithTinyAnglesLosesNoDigits) {
  PolarMeasurement z;
  z.range = 1e4;
  z.bearing = 0;
  z.variance = {1e-4, 1e-12, 4e-12};
  const Gaussian converted = *to_map(z, {}, 3);
  // Here linearisation is right to the next order, 1e-12.
  EXPECT_NEAR(converted.covariance(0, 0) / 1e-4, 1, 1e-9);
  EXPECT_NEAR(converted.covariance(1, 1) / (1e8 * 1e-12), 1, 1e-9);
  EXPECT_NEAR(converted.covariance(2, 2) / (1e8 * 4e-12), 1, 1e-9);
}

TEST(YawInMap, AddsTheHeading) {
  EXPECT_NEAR(yaw_in_map(0.3, {}), 0.3, 1e-15);
  EXPECT_NEAR(yaw_in_map(3, exact_pose({1, 2, 3}, turned(1, {0, 0, 1}))), 4 - 2 * kPi, 1e-12);
  // A sensor that hangs upside down (rolled by pi) sees headings mirrored.
  EXPECT_NEAR(yaw_in_map(0.3, exact_pose({0, 0, 0}, turned(kPi, {1, 0, 0}))), -0.3, 1e-12);
}

}  // namespace
}  // namespace anchord
