#pragma once

#include <Eigen/Core>

namespace anchord {

/// A normal density over a position in the map frame, metres. In a 2-D world (`dims` = 2 wherever
/// it is passed) z and the third row and column of the covariance are zero and not looked at.
struct Gaussian {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

}  // namespace anchord
