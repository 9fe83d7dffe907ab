#pragma once

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <opencv2/core.hpp>

#include "perception/verifier.h"

namespace anchord {

inline const cv::Scalar kPavement(120, 125, 130), kRed(40, 30, 180), kBlue(190, 60, 30);

inline RegionOfInterest ellipsoid(const Eigen::Vector3d& center, double deviation, double radius) {
  RegionOfInterest region;
  region.p = 0.95;
  region.center = {center.x(), center.y(), center.z()};
  const double v = deviation * deviation;
  region.covariance = {v, 0, 0, 0, v, 0, 0, 0, v};
  region.radius = radius;
  return region;
}

inline Eigen::VectorXd position_of(const Sighting& sighting) {
  const auto& m = std::get<CartesianMeasurement>(sighting.detection.value().measurement);
  return Eigen::Map<const Eigen::VectorXd>(m.position.data(),
                                           static_cast<Eigen::Index>(m.position.size()));
}

inline Eigen::MatrixXd covariance_of(const Sighting& sighting) {
  const auto& m = std::get<CartesianMeasurement>(sighting.detection.value().measurement);
  const auto n = static_cast<Eigen::Index>(m.position.size());
  return Eigen::Map<const Eigen::MatrixXd>(m.covariance.data(), n, n);
}

inline double nees(const Sighting& sighting, const Eigen::VectorXd& truth) {
  const Eigen::VectorXd e = position_of(sighting) - truth.head(position_of(sighting).size());
  return e.dot(covariance_of(sighting).llt().solve(e));
}

/// Everything outside the box that a look reports is changed; the answer may not change.
inline void expect_reads_only(const cv::Rect& box, const cv::Mat& frame, const Task& task,
                              Verifier first, Verifier second) {
  cv::Mat other(frame.size(), CV_8UC3);
  cv::RNG(7).fill(other, cv::RNG::UNIFORM, 0, 255);
  frame(box).copyTo(other(box));
  const Sighting a = first.look({frame, {}}, task), b = second.look({other, {}}, task);
  EXPECT_EQ(a.box, box);
  EXPECT_EQ(b.box, box);
  EXPECT_EQ(a.sight, Sighting::Sight::kFound);
  EXPECT_EQ(a.detection, b.detection);
  EXPECT_NEAR(a.looked_at, static_cast<double>(box.area()) / frame.size().area(), 1e-12);
}

}  // namespace anchord
