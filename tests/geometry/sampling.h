#pragma once

#include <Eigen/Core>
#include <functional>
#include <numbers>
#include <optional>
#include <random>

#include "core/frame.h"
#include "geometry/gaussian.h"
#include "geometry/view.h"

namespace anchord {

inline constexpr double kPi = std::numbers::pi;

/// The random draws of a test; the seed is fixed, so a test that passes keeps passing.
class Sampler {
 public:
  explicit Sampler(unsigned seed) : engine_(seed) {}
  double normal() { return normal_(engine_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// `n` independent standard normal numbers.
  Eigen::VectorXd white(int n);
  /// A covariance with axes in random directions and standard deviations in [low, high]; in 2-D
  /// the third row and column are zero.
  Eigen::Matrix3d covariance(double low, double high, int dims);
  /// A unit quaternion, every orientation alike.
  std::array<double, 4> orientation();

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

/// M with M M' = covariance, which may be semidefinite: M white(n) is a draw from N(0, covariance).
Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance);

/// A pose without noise.
Pose exact_pose(const Eigen::Vector3d& position, const std::array<double, 4>& orientation);
/// w, x, y, z of a rotation by `angle` about `axis`.
std::array<double, 4> turned(double angle, const Eigen::Vector3d& axis);

struct Share {
  double value, error;  ///< the share and its standard error
};
/// The share of `count` draws from the density that satisfy the condition.
Share sampled_share(Sampler& sampler, const Gaussian& density, int count,
                    const std::function<bool(const Eigen::Vector3d&)>& condition);

/// Written anew from the definition of a view, with angles: whether a point of the sensor frame is
/// in a sector or frustum.
bool in_view(const View& view, const Eigen::Vector3d& p, int dims);

}  // namespace anchord
