#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "geometry/by_axis.h"

namespace anchord {

/// Covariance blocks of position and velocity, as Kinematic has them, without its means. In a 2-D
/// world z has no variance.
struct Covariance {
  Eigen::Matrix3d pp = Eigen::Matrix3d::Zero();  ///< m^2
  Eigen::Matrix3d pv = Eigen::Matrix3d::Zero();  ///< m^2/s
  Eigen::Matrix3d vv = Eigen::Matrix3d::Zero();  ///< (m/s)^2

  /// Motion over dt seconds: a random walk, or if it `moves`, white acceleration (kinematic.h).
  void predict(const ByAxis& psd, bool moves, double dt, int dims) {
    if (!moves) {
      for (int i = 0; i < dims; ++i) pp(i, i) += psd[i] * dt;
      return;
    }
    pp += dt * (pv + pv.transpose()) + dt * dt * vv;
    pv += dt * vv;
    for (int i = 0; i < dims; ++i) {
      pp(i, i) += psd[i] * dt * dt * dt / 3;
      pv(i, i) += psd[i] * dt * dt / 2;
      vv(i, i) += psd[i] * dt;
    }
  }

  /// P <- P - q K H P for a position measurement of covariance `noise`: Kalman's update for q = 1,
  /// its expectation over whether the measurement comes for q < 1 (Sinopoli et al. 2004).
  void update(const Eigen::Matrix3d& noise, double q, bool moves, int dims) {
    Eigen::Matrix3d s = pp + noise;
    if (dims == 2) s(2, 2) = 1;  // keeps it regular; z has no variance to be changed
    const Eigen::Matrix3d inverse = s.inverse();
    if (moves) {
      const Eigen::Matrix3d to_velocity = q * pv.transpose() * inverse;
      vv -= to_velocity * pv;
      pv -= q * pp * inverse * pv;
    }
    const Eigen::Matrix3d step = pp * inverse * pp;
    pp -= q * 0.5 * (step + step.transpose());
  }

  /// The mean of two, weights >= 0 with a sum above 0.
  static Covariance mean(double weight_a, const Covariance& a, double weight_b,
                         const Covariance& b) {
    const double u = weight_a / (weight_a + weight_b);
    return {u * a.pp + (1 - u) * b.pp, u * a.pv + (1 - u) * b.pv, u * a.vv + (1 - u) * b.vv};
  }
};

}  // namespace anchord
