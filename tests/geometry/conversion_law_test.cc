#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "geometry/conversion.h"
#include "tests/geometry/sampling.h"

namespace anchord {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Pose good_pose() {
  Pose pose = exact_pose({1, 2, 3}, turned(0.5, {1, 1, 1}));
  for (int i = 0; i < 6; ++i) pose.covariance[7 * i] = 0.01;
  return pose;
}

CartesianMeasurement good_position() {
  return {{1, 2, 3}, {0.01, 0, 0, 0, 0.02, 0.001, 0, 0.001, 0.03}};
}

PolarMeasurement good_polar() { return {4, 0.3, 0.1, {0.01, 0.02, 0.03}}; }

template <typename Measurement>
void refused(const Measurement& z, const Pose& pose, const std::string& field, int dims = 3) {
  const auto result = to_map(z, pose, dims);
  ASSERT_FALSE(result.ok()) << field;
  EXPECT_EQ(result.error().field, field);
}

TEST(Refusal, OfWrongCounts) {
  EXPECT_TRUE(to_map(good_position(), good_pose(), 3).ok());
  refused(good_position(), good_pose(), "position", 2);
  CartesianMeasurement flat{{1, 2}, {1, 0, 0, 1}};
  EXPECT_TRUE(to_map(flat, good_pose(), 2).ok());
  refused(flat, good_pose(), "position", 3);
  flat.covariance.clear();
  refused(flat, good_pose(), "covariance", 2);
  PolarMeasurement polar = good_polar();
  EXPECT_TRUE(to_map(polar, good_pose(), 3).ok());
  polar.variance.pop_back();
  refused(polar, good_pose(), "polar.variance");
}

TEST(Refusal, OfCovariancesThatAreNone) {
  const std::vector<std::vector<double>> bad = {
      {1, 0, 0, 0, 1, 0, 0, 0, 0},      // singular
      {1, 0, 0, 0, -1, 0, 0, 0, 1},     // a negative variance
      {1, 2, 0, 2, 1, 0, 0, 0, 1},      // a correlation of 2
      {1, 0.5, 0, 0.4, 1, 0, 0, 0, 1},  // not symmetric
      {1, 1, 0, 1, 1, 0, 0, 0, 1}};     // a correlation of 1
  for (const auto& covariance : bad) {
    CartesianMeasurement z = good_position();
    z.covariance = covariance;
    refused(z, good_pose(), "covariance");
  }
  for (const int i : {0, 1, 2}) {
    for (const double variance : {0.0, -1.0}) {
      PolarMeasurement z = good_polar();
      z.variance[i] = variance;
      refused(z, good_pose(), "polar.variance");
    }
  }
  for (const double range : {0.0, -1.0}) {
    PolarMeasurement z = good_polar();
    z.range = range;
    refused(z, good_pose(), "polar.range");
  }
}

TEST(Refusal, OfPosesThatAreNone) {
  for (const double norm : {0.0, 0.98, 1.02}) {
    Pose pose = good_pose();
    for (auto& q : pose.orientation) q *= norm;
    refused(good_polar(), pose, "pose.orientation");
  }
  for (const double norm : {0.992, 1.008}) {
    Pose pose = good_pose();
    for (auto& q : pose.orientation) q *= norm;
    EXPECT_TRUE(check_pose(pose).ok());
  }
  Pose pose = good_pose();
  pose.covariance[0] = -1e-3;
  refused(good_polar(), pose, "pose.covariance");
  pose = good_pose();
  pose.covariance[1] = pose.covariance[6] = 0.02;
  refused(good_polar(), pose, "pose.covariance");
  pose = good_pose();
  pose.covariance[1] = 0.005;
  refused(good_polar(), pose, "pose.covariance");
  pose = good_pose();
  pose.covariance[0] = 0;
  pose.covariance[1] = pose.covariance[6] = 1e-9;
  refused(good_polar(), pose, "pose.covariance");
}

TEST(Refusal, OfAnglesTooUncertainForACovariance) {
  PolarMeasurement z = good_polar();
  z.variance[1] = 1e4;
  refused(z, good_pose(), "polar.variance");
  Pose pose = good_pose();
  pose.covariance[35] = 1e4;
  refused(good_polar(), pose, "pose.covariance");
  refused(good_position(), pose, "pose.covariance");
}

TEST(Pose, MayBeSemidefinite) {
  Pose pose = good_pose();
  pose.covariance.fill(0);
  EXPECT_TRUE(check_pose(pose).ok());
  // x and yaw wholly correlated, all else exact.
  pose.covariance[0] = 0.04;
  pose.covariance[35] = 0.01;
  pose.covariance[5] = pose.covariance[30] = 0.02;
  EXPECT_TRUE(check_pose(pose).ok());
  EXPECT_TRUE(to_map(good_polar(), pose, 3).ok());
}

/// Laws are tried on the same cases every time, unless the environment says otherwise.
class Law : public testing::Test {
 protected:
  static void SetUpTestSuite() { setenv("RC_PARAMS", "seed=1 max_success=1000", 0); }
};

TEST_F(Law, NanOrInfinityAnywhereIsRefused) {
  const bool holds = rc::check([] {
    const double bad = *rc::gen::element(kNan, HUGE_VAL, -HUGE_VAL);
    Pose pose = good_pose();
    PolarMeasurement polar = good_polar();
    CartesianMeasurement position = good_position();
    const auto pick = [](int size) { return *rc::gen::inRange(0, size); };
    std::string field, same;
    switch (*rc::gen::inRange(0, 8)) {
      case 0:
        pose.position[pick(3)] = bad, field = "pose.position";
        break;
      case 1:
        pose.orientation[pick(4)] = bad, field = "pose.orientation";
        break;
      case 2:
        pose.covariance[pick(36)] = bad, field = "pose.covariance";
        break;
      case 3:
        position.position[pick(3)] = bad, field = "position";
        break;
      case 4:
        position.covariance[pick(9)] = bad, field = "covariance";
        break;
      case 5:
        polar.range = bad, field = "polar.range";
        break;
      case 6:
        (pick(2) ? polar.bearing : polar.elevation) = bad;
        field = std::isfinite(polar.bearing) ? "polar.elevation" : "polar.bearing";
        break;
      default:
        polar.variance[pick(3)] = bad, field = "polar.variance";
    }
    const auto from_position = to_map(position, pose, 3);
    const auto from_polar = to_map(polar, pose, 3);
    RC_ASSERT(!from_position.ok() || !from_polar.ok());
    RC_ASSERT((from_position.ok() ? from_polar : from_position).error().field == field);
  });
  EXPECT_TRUE(holds);
}

/// Numbers of all magnitudes, as a broken or hostile sender may send them.
rc::Gen<double> magnitude(int low, int high) {
  return rc::gen::map(rc::gen::inRange(low * 10, high * 10),
                      [](int tenths) { return std::pow(10.0, tenths / 10.0); });
}

TEST_F(Law, WhateverIsAcceptedIsSymmetricPositiveDefinite) {
  int accepted = 0, tried = 0;
  const bool holds = rc::check([&] {
    const int dims = *rc::gen::element(2, 3);
    Sampler sampler(*rc::gen::arbitrary<unsigned>());
    Pose pose = exact_pose({sampler.normal(), sampler.normal(), 1}, sampler.orientation());
    const double scale = *magnitude(-8, 1);
    Eigen::Matrix<double, 6, 6> factor;
    for (auto& x : factor.reshaped()) x = sampler.normal() * scale;
    if (*rc::gen::arbitrary<bool>()) factor.rightCols<4>().setZero();  // semidefinite
    const Eigen::Matrix<double, 6, 6> covariance = factor * factor.transpose();
    std::copy(covariance.data(), covariance.data() + 36, pose.covariance.begin());
    const PolarMeasurement polar{*magnitude(-6, 7),
                                 sampler.uniform(-9, 9),
                                 sampler.uniform(-2, 2),
                                 {*magnitude(-14, 4), *magnitude(-14, 2), *magnitude(-14, 2)}};
    const auto converted = to_map(polar, pose, dims);
    ++tried;
    if (!converted.ok()) return;
    ++accepted;
    const Eigen::MatrixXd p = converted->covariance.topLeftCorner(dims, dims);
    RC_ASSERT(converted->mean.allFinite() && p.allFinite());
    RC_ASSERT(p == p.transpose());
    RC_ASSERT(Eigen::LLT<Eigen::MatrixXd>(p).info() == Eigen::Success);
  });
  EXPECT_TRUE(holds);
  EXPECT_GT(accepted, tried / 2) << "the law is hardly tried";
}

}  // namespace
}  // namespace anchord
