#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "core/frame.h"

namespace anchord {

/// The rotation that turns sensor axes into map axes; the quaternion is normalised.
inline Eigen::Matrix3d rotation_of(const Pose& pose) {
  const auto& q = pose.orientation;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

/// The rotation about the map's z axis that has the heading of `rotation`: where its x axis points
/// in the map plane, or, for one that points straight up or down, what its y axis says.
inline Eigen::Matrix3d level(const Eigen::Matrix3d& rotation) {
  Eigen::Vector2d x = rotation.col(0).head<2>();
  if (x.norm() < 1e-6) x = {rotation(1, 1), -rotation(0, 1)};
  x.normalize();
  Eigen::Matrix3d leveled = Eigen::Matrix3d::Identity();
  leveled.topLeftCorner<2, 2>() << x.x(), -x.y(), x.y(), x.x();
  return leveled;
}

}  // namespace anchord
