#include "geometry/conversion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/rotation.h"

namespace anchord {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// How far two numbers that should be equal may be apart, relative to the standard deviations:
/// room for senders that compute in single precision.
constexpr double kRounding = 1e-6;

Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d k;
  k << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return k;
}

/// A measured vector on its way from the sensor into the map, with what is known of the true one.
/// Random rotations act on it one after the other, each about one axis by a normal angle; for
/// such a rotation every moment below is exact.
struct Journey {
  Vector3d unbiased;    ///< its average over measurements of one truth is the truth
  Vector3d mean;        ///< of the true vector, given the measurement
  Matrix3d covariance;  ///< of the true vector about `mean`, given the measurement
  Matrix3d with_position = Matrix3d::Zero();  ///< E[d_position d_vector']

  void rotate(const Matrix3d& rotation) {
    unbiased = rotation * unbiased;
    mean = rotation * mean;
    covariance = rotation * covariance * rotation.transpose();
    with_position = with_position * rotation.transpose();
  }

  /// A rotation about the unit vector `axis` by an angle ~ N(0, variance). `to_position` is the
  /// covariance of the sensor's position with that angle.
  /// With l = exp(-variance/2), E[cos] = l, E[cos^2] = (1 + l^4)/2, E[sin^2] = (1 - l^4)/2.
  void turn(const Vector3d& axis, double variance, const Vector3d& to_position) {
    if (variance <= 0) return;
    const Matrix3d along = axis * axis.transpose();
    const Matrix3d across = Matrix3d::Identity() - along;
    const Matrix3d quarter = cross_matrix(axis);  // turns the part across by 90 degrees
    const double l = std::exp(-variance / 2);
    const double lost = -std::expm1(-variance), lost_twice = -std::expm1(-2 * variance);
    const Vector3d radial = across * mean, tangential = quarter * mean;

    with_position =
        (with_position * (along + l * across) + to_position * (l * tangential).transpose()).eval();
    const Matrix3d mixed = along * covariance * across;
    covariance = (along * covariance * along + l * (mixed + mixed.transpose()) +
                  (1 - lost_twice / 2) * across * covariance * across +
                  lost_twice / 2 * quarter * covariance * quarter.transpose() +
                  lost * lost / 2 * radial * radial.transpose() +
                  lost_twice / 2 * tangential * tangential.transpose())
                     .eval();
    mean = (along * mean + l * radial).eval();
    unbiased += std::expm1(variance / 2) * (across * unbiased);
  }
};

template <typename Square>
bool symmetric_and(const Square& covariance, double slack) {
  constexpr Eigen::Index n = Square::RowsAtCompileTime;
  if (!covariance.allFinite()) return false;
  using Matrix = Eigen::Matrix<double, n, n>;
  Matrix correlation = Matrix::Identity();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (covariance(i, i) < 0 || (slack == 0 && covariance(i, i) == 0)) return false;
    for (Eigen::Index j = 0; j < i; ++j) {
      const double scale = std::sqrt(covariance(i, i)) * std::sqrt(covariance(j, j));
      const double a = covariance(i, j), b = covariance(j, i);
      if (scale == 0 && (a != 0 || b != 0)) return false;
      if (std::abs(a - b) > kRounding * scale) return false;
      if (scale > 0) correlation(i, j) = correlation(j, i) = (a + b) / 2 / scale;
    }
    correlation(i, i) += slack;
  }
  if (!correlation.allFinite()) return false;
  const Eigen::LLT<Matrix> factor(correlation);
  return factor.info() == Eigen::Success;
}

/// Of its leading `dims` rows and columns.
bool positive_definite(const Matrix3d& covariance, int dims) {
  return dims == 2 ? symmetric_and(covariance.topLeftCorner<2, 2>(), 0)
                   : symmetric_and(covariance, 0);
}

Matrix6d symmetric_covariance(const Pose& pose) {
  const Matrix6d covariance =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(pose.covariance.data());
  return (covariance + covariance.transpose()) / 2;
}

/// The last part of the way: through the pose into the map. `culprit` is the field to name if the
/// angles are so uncertain that no covariance is left.
Result<Gaussian> through_pose(Journey journey, const std::optional<Pose>& pose, int dims,
                              const char* culprit) {
  Gaussian result;
  if (pose) {
    if (Status status = check_pose(*pose); !status) return status.error();
    const Matrix3d rotation = rotation_of(*pose);
    Matrix6d covariance = symmetric_covariance(*pose);
    Vector3d position(pose->position[0], pose->position[1], pose->position[2]);
    journey.rotate(dims == 2 ? level(rotation) : rotation);
    if (dims == 2) {
      // x, y and yaw alone.
      position.z() = 0;
      for (const int unused : {2, 3, 4}) {
        covariance.row(unused).setZero();
        covariance.col(unused).setZero();
      }
      journey.turn(Vector3d::UnitZ(), covariance(5, 5), covariance.block<3, 1>(0, 5));
    } else if (!covariance.bottomRightCorner<3, 3>().isZero(0)) {
      // The small rotations as independent ones about the principal axes: exact for a heading
      // alone, to second order together.
      const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(covariance.bottomRightCorner<3, 3>());
      for (int i = 0; i < 3; ++i) {
        const Vector3d axis = axes.eigenvectors().col(i);
        journey.turn(axis, axes.eigenvalues()[i], covariance.topRightCorner<3, 3>() * axis);
      }
    }
    if (covariance.diagonal().tail<3>().maxCoeff() > 1) culprit = "pose.covariance";
    result.mean = position;
    result.covariance = covariance.topLeftCorner<3, 3>();
  }
  const Vector3d bias = journey.unbiased - journey.mean;
  result.mean += journey.unbiased;
  result.covariance += journey.covariance + journey.with_position +
                       journey.with_position.transpose() + bias * bias.transpose();
  result.covariance = ((result.covariance + result.covariance.transpose()) / 2).eval();
  if (dims == 2) {
    result.mean.z() = 0;
    result.covariance.row(2).setZero();
    result.covariance.col(2).setZero();
  }
  if (!result.mean.allFinite() || !positive_definite(result.covariance, dims))
    return invalid(culprit,
                   "gives no finite, positive definite covariance in the map frame: too large, "
                   "too small or too unequal");
  return result;
}

std::string must_have(std::size_t count) {
  return "must have " + std::to_string(count) + " numbers";
}

}  // namespace

Status check_pose(const Pose& pose) {
  const auto finite = [](const auto& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  if (!finite(pose.position)) return invalid("pose.position", "must be finite numbers");
  const auto& q = pose.orientation;
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(norm - 1) <= 0.01))
    return invalid("pose.orientation", "must be a quaternion w, x, y, z of norm 1 (within 1 %)");
  if (!finite(pose.covariance)) return invalid("pose.covariance", "must be finite numbers");
  const auto is_zero = [](double x) { return x == 0; };
  if (std::all_of(pose.covariance.begin(), pose.covariance.end(), is_zero)) return Done{};
  if (!symmetric_and(
          Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(pose.covariance.data()),
          kRounding))
    return invalid("pose.covariance", "must be symmetric and positive semidefinite");
  return Done{};
}

Result<Gaussian> to_map(const CartesianMeasurement& measurement, const std::optional<Pose>& pose,
                        int dims) {
  const auto n = static_cast<std::size_t>(dims);
  if (measurement.position.size() != n) return invalid("position", must_have(n));
  if (measurement.covariance.size() != n * n) return invalid("covariance", must_have(n * n));
  Journey journey{Vector3d::Zero(), Vector3d::Zero(), Matrix3d::Zero()};
  for (int i = 0; i < dims; ++i) {
    journey.mean[i] = measurement.position[i];
    for (int j = 0; j < dims; ++j) journey.covariance(i, j) = measurement.covariance[i * n + j];
  }
  if (!journey.mean.allFinite()) return invalid("position", "must be finite numbers");
  if (!positive_definite(journey.covariance, dims))
    return invalid("covariance", "must be finite, symmetric and positive definite");
  journey.unbiased = journey.mean;
  return through_pose(journey, pose, dims, "covariance");
}

Result<Gaussian> to_map(const PolarMeasurement& measurement, const std::optional<Pose>& pose,
                        int dims) {
  if (!(measurement.range > 0) || !std::isfinite(measurement.range))
    return invalid("polar.range", "must be a finite number above 0");
  if (!std::isfinite(measurement.bearing)) return invalid("polar.bearing", "must be finite");
  if (!std::isfinite(measurement.elevation)) return invalid("polar.elevation", "must be finite");
  if (measurement.variance.size() != 3) return invalid("polar.variance", must_have(3));
  for (int i = 0; i < 3; ++i) {
    const double variance = measurement.variance[i];
    const bool used = dims == 3 || i < 2;
    if (!std::isfinite(variance) || (used ? variance <= 0 : variance < 0))
      return invalid("polar.variance", "must be finite numbers above 0");
  }
  Journey journey{measurement.range * Vector3d::UnitX(), measurement.range * Vector3d::UnitX(),
                  Vector3d(measurement.variance[0], 0, 0).asDiagonal()};
  if (dims == 3) {
    journey.turn(Vector3d::UnitY(), measurement.variance[2], Vector3d::Zero());
    journey.rotate(Eigen::AngleAxisd(-measurement.elevation, Vector3d::UnitY()).toRotationMatrix());
  }
  journey.turn(Vector3d::UnitZ(), measurement.variance[1], Vector3d::Zero());
  journey.rotate(Eigen::AngleAxisd(measurement.bearing, Vector3d::UnitZ()).toRotationMatrix());
  return through_pose(journey, pose, dims, "polar.variance");
}

double yaw_in_map(double yaw, const std::optional<Pose>& pose) {
  Vector3d direction(std::cos(yaw), std::sin(yaw), 0);
  if (pose) direction = (rotation_of(*pose) * direction).eval();
  return std::atan2(direction.y(), direction.x());
}

}  // namespace anchord
