#include "perception/camera.h"

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/rotation.h"

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

CameraParameters pinhole(int width, int height, double focal) {
  CameraParameters result;
  result.width = width;
  result.height = height;
  result.focal = focal;  // with pixels of 1 mm
  result.dpx = result.dpy = 1;
  result.cx = (width - 1) / 2.0;
  result.cy = (height - 1) / 2.0;
  return result;
}

Camera::Camera(const CameraParameters& parameters) : parameters_(parameters) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  rotation_ = (AngleAxisd(parameters.rotation.z(), Vector3d::UnitZ()) *
               AngleAxisd(parameters.rotation.y(), Vector3d::UnitY()) *
               AngleAxisd(parameters.rotation.x(), Vector3d::UnitX()))
                  .toRotationMatrix();
  centre_map_ = -(rotation_.transpose() * parameters.translation);
}

Camera Camera::at(const Pose& pose) const {
  Eigen::Matrix3d camera_from_sensor;
  camera_from_sensor << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  Camera result = *this;
  result.rotation_ = camera_from_sensor * rotation_of(pose).transpose();
  result.centre_map_ = Eigen::Vector3d(pose.position.data());
  result.parameters_.translation = -(result.rotation_ * result.centre_map_);
  return result;
}

Eigen::Vector2d Camera::project(const Eigen::Vector3d& p_map) const {
  const CameraParameters& c = parameters_;
  const Eigen::Vector3d p_camera = rotation_ * p_map + c.translation;
  Eigen::Vector2d on_sensor = c.focal * p_camera.head<2>() / p_camera.z();
  const double r_ideal = on_sensor.norm();
  if (r_ideal > 0) on_sensor *= distorted_radius(r_ideal, c.kappa1) / r_ideal;
  return {c.sx * on_sensor.x() / c.dpx + c.cx, on_sensor.y() / c.dpy + c.cy};
}

Camera::Ray Camera::ray(const Eigen::Vector2d& pixel) const {
  const CameraParameters& c = parameters_;
  const Eigen::DiagonalMatrix<double, 2> scale(c.dpx / c.sx, c.dpy);
  const Eigen::Vector2d distorted = scale * (pixel - Eigen::Vector2d(c.cx, c.cy));
  const double stretch = 1 + c.kappa1 * distorted.squaredNorm();
  Ray ray;
  ray.direction << stretch * distorted / c.focal, 1;
  ray.change.topRows<2>() =
      (stretch * Eigen::Matrix2d::Identity() + 2 * c.kappa1 * distorted * distorted.transpose()) *
      scale / c.focal;
  ray.change.row(2).setZero();
  return ray;
}

std::optional<GroundPoint> Camera::to_ground(const Eigen::Vector2d& pixel) const {
  return to_plane(pixel, 0);
}

std::optional<GroundPoint> Camera::to_plane(const Eigen::Vector2d& pixel, double z) const {
  const Ray from_camera = ray(pixel);
  const Eigen::Vector3d direction = rotation_.transpose() * from_camera.direction;
  const double distance = (z - centre_map_.z()) / direction.z();  // in units of the ray
  if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;

  const Eigen::Matrix<double, 3, 2> change = rotation_.transpose() * from_camera.change;
  GroundPoint ground;
  ground.position = centre_map_.head<2>() + distance * direction.head<2>();
  ground.jacobian = distance * (change.topRows<2>() -
                                direction.head<2>() / direction.z() * change.bottomRows<1>());
  return ground;
}

double Camera::depth(const Eigen::Vector3d& p_map) const {
  return rotation_.row(2).dot(p_map) + parameters_.translation.z();
}

SpacePoint Camera::at_depth(const Eigen::Vector2d& pixel, double depth) const {
  const Ray from_camera = ray(pixel);
  SpacePoint point;
  point.position =
      rotation_.transpose() * (depth * from_camera.direction - parameters_.translation);
  point.jacobian.leftCols<2>() = rotation_.transpose() * depth * from_camera.change;
  point.jacobian.col(2) = rotation_.transpose() * from_camera.direction;
  return point;
}

Camera Camera::part(int left, int top, int width, int height) const {
  Camera result = *this;
  result.parameters_.cx -= left;
  result.parameters_.cy -= top;
  result.parameters_.width = width;
  result.parameters_.height = height;
  return result;
}

}  // namespace anchord
