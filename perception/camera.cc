#include "perception/camera.h"

#include <Eigen/Geometry>
#include <cmath>

namespace anchord {

namespace {

/// Solves r_ideal = r (1 + kappa r^2) for the distorted radius r by Newton's method. The function
/// rises for every r in a picture (kappa r^2 is small), so that a handful of steps reach rounding.
double distorted_radius(double r_ideal, double kappa) {
  double r = r_ideal;
  for (int step = 0; step < 20; ++step) {
    const double error = r * (1 + kappa * r * r) - r_ideal;
    const double next = r - error / (1 + 3 * kappa * r * r);
    if (next == r) break;
    r = next;
  }
  return r;
}

}  // namespace

Camera::Camera(const CameraParameters& parameters) : parameters_(parameters) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  rotation_ = (AngleAxisd(parameters.rotation.z(), Vector3d::UnitZ()) *
               AngleAxisd(parameters.rotation.y(), Vector3d::UnitY()) *
               AngleAxisd(parameters.rotation.x(), Vector3d::UnitX()))
                  .toRotationMatrix();
  centre_map_ = -(rotation_.transpose() * parameters.translation);
}

Eigen::Vector2d Camera::project(const Eigen::Vector3d& p_map) const {
  const CameraParameters& c = parameters_;
  const Eigen::Vector3d p_camera = rotation_ * p_map + c.translation;
  Eigen::Vector2d on_sensor = c.focal * p_camera.head<2>() / p_camera.z();
  const double r_ideal = on_sensor.norm();
  if (r_ideal > 0) on_sensor *= distorted_radius(r_ideal, c.kappa1) / r_ideal;
  return {c.sx * on_sensor.x() / c.dpx + c.cx, on_sensor.y() / c.dpy + c.cy};
}

std::optional<GroundPoint> Camera::to_ground(const Eigen::Vector2d& pixel) const {
  const CameraParameters& c = parameters_;
  const Eigen::DiagonalMatrix<double, 2> scale(c.dpx / c.sx, c.dpy);
  const Eigen::Vector2d distorted = scale * (pixel - Eigen::Vector2d(c.cx, c.cy));
  const double stretch = 1 + c.kappa1 * distorted.squaredNorm();
  const Eigen::Matrix2d d_ideal =
      (stretch * Eigen::Matrix2d::Identity() + 2 * c.kappa1 * distorted * distorted.transpose()) *
      scale;
  Eigen::Vector3d ray_camera;
  ray_camera << stretch * distorted, c.focal;
  const Eigen::Vector3d ray = rotation_.transpose() * ray_camera;
  const double distance = -centre_map_.z() / ray.z();  // in units of the ray
  if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;

  const Eigen::Matrix<double, 3, 2> d_ray = rotation_.transpose().leftCols<2>() * d_ideal;
  GroundPoint ground;
  ground.position = centre_map_.head<2>() + distance * ray.head<2>();
  ground.jacobian =
      distance * (d_ray.topRows<2>() - ray.head<2>() / ray.z() * d_ray.bottomRows<1>());
  return ground;
}

}  // namespace anchord
