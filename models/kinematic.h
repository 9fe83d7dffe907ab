#pragma once

#include <Eigen/Core>

#include "geometry/by_axis.h"
#include "geometry/gaussian.h"

namespace anchord {

/// The Gaussian density of a tracked behaviour model over position and velocity, map frame,
/// kept in blocks. In a 2-D world (`dims` = 2) only the leading 2 entries of each block are used.
/// A constant-position model leaves the velocity blocks zero.
struct Kinematic {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Matrix3d pp = Eigen::Matrix3d::Zero();        ///< covariance of position, m^2
  Eigen::Matrix3d pv = Eigen::Matrix3d::Zero();        ///< cov(position, velocity), m^2/s
  Eigen::Matrix3d vv = Eigen::Matrix3d::Zero();        ///< covariance of velocity, (m/s)^2

  bool operator==(const Kinematic&) const = default;
  Gaussian position_density() const { return {position, pp}; }
};

/// A density at a first measurement: its mean and covariance, velocity 0 with that variance.
Kinematic kinematic_at(const Gaussian& measurement, const ByAxis& velocity_variance, int dims);

/// A random walk: pp grows by psd dt (psd in m^2/s, dt >= 0 in s).
void predict_constant_position(Kinematic& state, const ByAxis& psd, double dt, int dims);

/// White acceleration of power spectral density psd (m^2/s^3): per axis
/// Q = psd [[dt^3/3, dt^2/2], [dt^2/2, dt]] (Bar-Shalom, Li, Kirubarajan 2001, section 6.2.2).
void predict_constant_velocity(Kinematic& state, const ByAxis& psd, double dt, int dims);

/// How well a position measurement fits a predicted density.
struct Fit {
  double log_likelihood;  ///< ln N(z; position, pp + R), per m^dims
  double distance2;       ///< squared Mahalanobis distance
};
/// R must be positive definite.
Fit fit(const Kinematic& state, const Gaussian& measurement, int dims);

/// Kalman update by a position measurement with positive definite R. Joseph's form for the
/// position block, so that a very exact measurement leaves it positive definite.
void update(Kinematic& state, const Gaussian& measurement, int dims);

/// The Gaussian with the mean and covariance of the mixture of two; weights > 0, any sum.
Kinematic merge(double weight_a, const Kinematic& a, double weight_b, const Kinematic& b);

/// Raises every eigenvalue of pp that lies below `floor` (m^2) to it.
void keep_above(Kinematic& state, double floor, int dims);

}  // namespace anchord
