#include "tests/geometry/sampling.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace anchord {

Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

Eigen::VectorXd Sampler::white(int n) {
  Eigen::VectorXd numbers(n);
  for (auto& x : numbers) x = normal();
  return numbers;
}

std::array<double, 4> Sampler::orientation() {
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(normal(), normal(), normal(), normal()).normalized();
  return {q.w(), q.x(), q.y(), q.z()};
}

Eigen::Matrix3d Sampler::covariance(double low, double high, int dims) {
  Eigen::Vector3d sigma(uniform(low, high), uniform(low, high), uniform(low, high));
  const auto q = orientation();
  Eigen::Matrix3d axes = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  if (dims == 2) {
    axes = Eigen::AngleAxisd(uniform(-kPi, kPi), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    sigma.z() = 0;
  }
  const Eigen::Matrix3d product = axes * sigma.cwiseAbs2().asDiagonal() * axes.transpose();
  return (product + product.transpose()) / 2;
}

Pose exact_pose(const Eigen::Vector3d& position, const std::array<double, 4>& orientation) {
  Pose pose;
  pose.position = {position.x(), position.y(), position.z()};
  pose.orientation = orientation;
  return pose;
}

std::array<double, 4> turned(double angle, const Eigen::Vector3d& axis) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis.normalized()));
  return {q.w(), q.x(), q.y(), q.z()};
}

Share sampled_share(Sampler& sampler, const Gaussian& density, int count,
                    const std::function<bool(const Eigen::Vector3d&)>& condition) {
  const Eigen::Matrix3d factor = root_of(density.covariance);
  int inside = 0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d white(sampler.normal(), sampler.normal(), sampler.normal());
    inside += condition(density.mean + factor * white) ? 1 : 0;
  }
  const double share = static_cast<double>(inside) / count;
  // At least that of three hits, so that a share of 0 or 1 leaves room for a small mass.
  return {share, std::sqrt(std::max(share * (1 - share), 3.0 / count) / count)};
}

bool in_view(const View& view, const Eigen::Vector3d& p, int dims) {
  const double range = dims == 2 ? std::hypot(p.x(), p.y()) : p.norm();
  if (range < view.range[0] || range > view.range[1]) return false;
  const double bearing = std::atan2(p.y(), p.x());
  if (view.type == View::Type::kFrustum) {
    if (p.x() <= 0 || std::abs(p.y() / p.x()) > std::tan(view.hfov / 2)) return false;
    return dims == 2 || std::abs(p.z() / p.x()) <= std::tan(view.vfov / 2);
  }
  const double width = view.bearing[1] - view.bearing[0];
  const double turn = 2 * kPi;
  const auto positive = [&](double angle) { return angle - turn * std::floor(angle / turn); };
  if (width < turn && positive(bearing - view.bearing[0]) > positive(width)) return false;
  const double elevation = std::atan2(p.z(), std::hypot(p.x(), p.y()));
  return dims == 2 || (elevation >= view.elevation[0] && elevation <= view.elevation[1]);
}

}  // namespace anchord
