#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "core/frame.h"
#include "geometry/rotation.h"

namespace anchord {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// An exact pose: yaw to the left, then pitch downwards, then roll to the right.
inline Pose pose_of(const Eigen::Vector3d& position, double yaw, double pitch = 0,
                    double roll = 0) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  Pose pose;
  pose.position = {position.x(), position.y(), position.z()};
  pose.orientation = {q.w(), q.x(), q.y(), q.z()};
  return pose;
}

inline Pose with_covariance(Pose pose, const Matrix6d& covariance) {
  std::copy_n(covariance.data(), 36, pose.covariance.begin());
  return pose;
}

inline Pose with_deviations(const Pose& pose, const Vector6d& deviations) {
  return with_covariance(pose, deviations.cwiseAbs2().asDiagonal());
}

inline Matrix6d covariance_of(const Pose& pose) {
  return Eigen::Map<const Matrix6d>(pose.covariance.data());
}

/// The pose moved by (dp, dr), dr a rotation about the map's axes.
inline Pose moved(Pose pose, const Vector6d& step) {
  for (int i = 0; i < 3; ++i) pose.position[static_cast<std::size_t>(i)] += step[i];
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  if (angle == 0) return pose;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, turn / angle) * rotation_of(pose));
  pose.orientation = {q.w(), q.x(), q.y(), q.z()};
  return pose;
}

/// The pose with an error drawn from its covariance, which must be positive definite.
template <typename Random>
Pose disturbed(const Pose& pose, Random& random) {
  std::normal_distribution<double> normal;
  Vector6d draw;
  for (double& x : draw) x = normal(random);
  return moved(pose, covariance_of(pose).llt().matrixL() * draw);
}

}  // namespace anchord
