#include "perception/camera_pose.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/conversion.h"
#include "geometry/rotation.h"

namespace anchord {

namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kFarthest = 1e6;        ///< m
constexpr double kMostVariance = 1e8;    ///< m^2
constexpr double kMostTurn = 1;          ///< rad^2
constexpr double kRoom = 2.796;          ///< standard deviations: 95 % in space
constexpr double kMostOfDistance = 0.2;  ///< the second order is then a fifth of a deviation

Matrix6d covariance_of(const Pose& pose) {
  const Matrix6d c = Eigen::Map<const Matrix6d>(pose.covariance.data());
  return (c + c.transpose()) / 2;
}

Vector3d from_camera(const Vector3d& point, const Pose& pose) {
  return point - Vector3d(pose.position.data());
}

/// How a point at `r` from the camera appears to move with (dp, dr).
Eigen::Matrix<double, 3, 6> change(const Vector3d& r) {
  Eigen::Matrix<double, 3, 6> result;
  result.leftCols<3>().setIdentity();
  result.rightCols<3>() << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;  // dr x r
  return result;
}

/// The same of what is seen on a horizontal plane: the ray slides along it.
Eigen::Matrix<double, 2, 6> change_on_plane(const Vector3d& r) {
  const auto in_space = change(r);
  return in_space.topRows<2>() - r.head<2>() / r.z() * in_space.bottomRows<1>();
}

/// The part of `change_on_plane` that to_map() does not know: height and tilt.
Eigen::Matrix<double, 2, 6> change_unknown_to_map(Eigen::Matrix<double, 2, 6> change) {
  for (const int known : {0, 1, 5}) change.col(known).setZero();
  return change;
}

/// The covariance of the apparent position of a point.
Matrix3d spread(const Vector3d& point, const Pose& pose) {
  const auto j = change(from_camera(point, pose));
  return j * covariance_of(pose) * j.transpose();
}

/// Without what is negative of a symmetric matrix.
Matrix2d not_negative(const Matrix2d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> axes(matrix);
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).asDiagonal() *
         axes.eigenvectors().transpose();
}

bool at_most(const Pose& pose, int from, int to, double most) {
  return (covariance_of(pose).diagonal().segment(from, to - from).array() <= most).all();
}

}  // namespace

Status check_camera_pose(const Pose& pose) {
  if (Status good = check_pose(pose); !good) return good;
  for (const double x : pose.position) {
    if (!(std::abs(x) <= kFarthest)) return invalid("pose.position", "is not a place");
  }
  if (!at_most(pose, 0, 3, kMostVariance) || !at_most(pose, 3, 6, kMostTurn)) {
    return invalid("pose.covariance", "is too large to see anything by");
  }
  return Done{};
}

Gaussian in_sensor_frame(const Gaussian& measured, double height, const Pose& pose, int dims) {
  Gaussian result;
  if (dims == 3) {
    const Matrix3d to_sensor = rotation_of(pose).transpose();
    result.mean = to_sensor * from_camera(measured.mean, pose);
    result.covariance = to_sensor * measured.covariance * to_sensor.transpose();
    return result;
  }
  const Vector3d r = from_camera({measured.mean.x(), measured.mean.y(), height}, pose);
  const Eigen::Matrix<double, 2, 6> all = change_on_plane(r);
  const Eigen::Matrix<double, 2, 6> unknown = change_unknown_to_map(all), known = all - unknown;
  const Matrix6d c = covariance_of(pose);
  const Matrix2d with_known = known * c * unknown.transpose();
  const Matrix2d added =
      not_negative(unknown * c * unknown.transpose() + with_known + with_known.transpose());
  const Matrix2d to_level = level(rotation_of(pose)).topLeftCorner<2, 2>().transpose();
  result.mean.head<2>() = to_level * r.head<2>();
  result.covariance.topLeftCorner<2, 2>() =
      to_level * (measured.covariance.topLeftCorner<2, 2>() + added) * to_level.transpose();
  return result;
}

bool ground_is_known(const Vector3d& point, const Pose& pose) {
  const Vector3d r = from_camera(point, pose);
  const auto j = change_unknown_to_map(change_on_plane(r));
  const Matrix2d covariance = j * covariance_of(pose) * j.transpose();
  // Written so that a point at the camera's own height, which has no ground, is not known.
  return covariance.trace() <= kMostOfDistance * kMostOfDistance * r.squaredNorm();
}

std::vector<Placement> apparent_places(const std::vector<Placement>& places, const Pose& pose,
                                       int dims) {
  std::vector<Placement> result;
  for (const Placement& place : places) {
    if (dims == 2 && !ground_is_known(place.position, pose)) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(spread(place.position, pose));
    for (int i = 0; i < 3; ++i) {
      // The six points at root of three deviations have the covariance (the unscented transform's).
      const Vector3d step =
          std::sqrt(3 * std::max(0.0, axes.eigenvalues()[i])) * axes.eigenvectors().col(i);
      result.push_back({place.position + step, place.weight / 6});
      result.push_back({place.position - step, place.weight / 6});
    }
  }
  return result;
}

Body apparent_body(Body body, const std::vector<Placement>& places, const Pose& pose) {
  double aside = 0, upwards = 0;
  for (const Placement& place : places) {
    const Matrix3d covariance = spread(place.position, pose);
    aside = std::max(aside, covariance.topLeftCorner<2, 2>().trace());
    upwards = std::max(upwards, covariance(2, 2));
  }
  body.radius += kRoom * std::sqrt(aside);
  body.below += kRoom * std::sqrt(upwards);
  body.above += kRoom * std::sqrt(upwards);
  return body;
}

}  // namespace anchord
