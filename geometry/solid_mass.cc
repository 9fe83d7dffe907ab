#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "geometry/half_plane.h"
#include "geometry/quadrature.h"
#include "geometry/ray_mass.h"
#include "geometry/standard_normal.h"
#include "geometry/view.h"

namespace anchord {

/// 3-D: over half-planes that hold the sensor's z axis, with the integral over each.
double MapView::solid_mass(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance,
                           bool any_range, const MassPrecision& precision) const {
  using Eigen::Matrix2d;
  using Eigen::Matrix3d;
  using Eigen::Vector2d;
  using Eigen::Vector3d;
  constexpr double kPi = std::numbers::pi;
  const Matrix3d whiten = upper_factor<3>(covariance).inverse();
  const Vector3d white_mean = whiten * mean;
  const Matrix2d flat_factor = upper_factor<2>(covariance.topLeftCorner<2, 2>());
  const WhitePlane ground(flat_factor, solve_upper(flat_factor, mean.head<2>()), precision.reach);
  const double scale =
      whiten.determinant() * flat_factor.determinant() / (2 * kPi * std::sqrt(2 * kPi));
  const double inner_tolerance = precision.tolerance / (2 * ground.reach);
  const double least = 0.1 * inner_tolerance;
  const Vector2d low(std::cos(elevation_min_), std::sin(elevation_min_));
  const Vector2d high(std::cos(elevation_max_), std::sin(elevation_max_));

  const auto half_plane = [&](double ground_theta) {
    Vector2d forward = flat_factor * Vector2d(std::cos(ground_theta), std::sin(ground_theta));
    const double stretch = forward.norm();
    forward /= stretch;
    // The half-plane's axes, forward and up, in white coordinates, and its distance to the mean.
    const Vector3d white_forward = whiten.leftCols<2>() * forward, white_up = whiten.col(2);
    const Vector3d normal = white_forward.cross(white_up);
    const double area = normal.norm(), length = white_forward.norm();
    const double off = white_mean.dot(normal) / area;
    const Vector3d axis_x = white_forward / length, axis_y = normal.cross(axis_x) / area;
    // Within it: a white plane of its own; unfold is the inverse of its whitening.
    HalfPlane part;
    part.unfold << 1 / length, -axis_x.dot(white_up) / area, 0, length / area;
    part.mean = {white_mean.dot(axis_x), white_mean.dot(axis_y)};
    part.low = low;
    part.high = high;
    if (type_ == View::Type::kFrustum) {
      part.low.y() *= forward.x();
      part.high.y() *= forward.x();
    }
    part.range_min = range_min_;
    part.range_max = range_max_;
    const double jacobian = scale * std::exp(-off * off / 2) / (area * stretch * stretch);
    // All that the half-plane may hold: its points' distance from the z axis is unfold.row(0) p.
    const double outward = std::abs(part.unfold.row(0).dot(part.mean)) + part.unfold.row(0).norm();
    if (2 * kPi * jacobian * outward < least) return 0.0;
    return jacobian * part.moment(any_range, precision, inner_tolerance / jacobian);
  };
  return integrate_around(half_plane, ground.direction_of(bearing_from_),
                          ground.direction_of(bearing_from_ + bearing_width_), ground.peak,
                          ground.reach, precision.tolerance, 12);
}

}  // namespace anchord
