#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/gaussian_mass.h"
#include "geometry/quadrature.h"
#include "geometry/ray_mass.h"
#include "geometry/standard_normal.h"
#include "geometry/view.h"

namespace anchord {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

/// Mass of a wedge with its tip at the sensor, from bearing `from` over `width`, without end.
double wedge_mass(const Vector2d& mean, const Matrix2d& covariance, double from, double width) {
  const Matrix2d factor = upper_factor<2>(covariance);
  const WhitePlane plane(factor, solve_upper(factor, mean), MassPrecision(0).reach);
  const double first = plane.direction_of(from), second = plane.direction_of(from + width);
  const Vector2d tip = -plane.mean;
  const double sum = (second - first) / (2 * kPi) +
                     ray_triangle_mass(tip, {std::cos(first), std::sin(first)}) -
                     ray_triangle_mass(tip, {std::cos(second), std::sin(second)});
  return std::clamp(sum, 0.0, 1.0);
}

}  // namespace

/// Where a density stands against the limits, looking at its spread across each of them. A sphere
/// of precision.clear standard deviations has been tried before; this sharpens what it left open.
MapView::Clearance MapView::clearance(const Vector3d& mean, const Matrix3d& covariance,
                                      const Depth& at_mean, double sphere,
                                      const MassPrecision& precision) const {
  const auto deviation = [&](const Vector3d& normal) {
    return std::sqrt(std::max(normal.dot(covariance * normal), 0.0));
  };
  Clearance clear{at_mean.range >= sphere, at_mean.bearing >= sphere, at_mean.elevation >= sphere,
                  false};
  if (!clear.range) {
    const double distance = mean.norm();
    const double sigma = deviation(mean / std::max(distance, 1e-12)),
                 radial = precision.clear * sigma;
    const double across = std::max(sphere * sphere - radial * radial, 0.0);
    const double farthest = std::sqrt((distance + radial) * (distance + radial) + across);
    clear.range = farthest <= range_max_ && (range_min_ == 0 || distance - radial >= range_min_);
    clear.outside = distance - precision.outside * sigma >= range_max_;
  }
  if (!clear.bearing) {
    bool inside[2], outside[2];
    for (int i = 0; i < 2; ++i) {
      const double depth = bearing_normal_[i].dot(mean), sigma = deviation(bearing_normal_[i]);
      inside[i] = depth >= precision.clear * sigma;
      outside[i] = depth <= -precision.outside * sigma;
    }
    const bool narrow = bearing_width_ <= kPi;
    clear.bearing = narrow ? inside[0] && inside[1] : inside[0] || inside[1];
    clear.outside |= narrow ? outside[0] || outside[1] : outside[0] && outside[1];
  }
  if (!clear.elevation) {
    const bool planes = type_ == View::Type::kFrustum;
    const double flat = along(mean);
    const Vector3d outward =
        planes ? Vector3d(1, 0, 0) : Vector3d(mean.x(), mean.y(), 0) / std::max(flat, 1e-12);
    clear.elevation = true;
    const auto test = [&](const Vector2d& normal) {
      // A cone's outside is convex on one side of the horizon and its inside on the other; there
      // the plane that touches it bounds what lies beyond.
      const double depth = normal.dot(Vector2d(flat, mean.z()));
      const double sigma = deviation(normal.x() * outward + Vector3d(0, 0, normal.y()));
      clear.elevation &=
          depth >= sphere || ((planes || normal.x() >= 0) && depth >= precision.clear * sigma);
      clear.outside |= (planes || normal.x() <= 0) && depth <= -precision.outside * sigma;
    };
    if (has_floor_) test(floor_normal_);
    if (has_ceiling_) test(ceiling_normal_);
  }
  return clear;
}

double MapView::mass(const Gaussian& density, double tolerance) const {
  if (sees_everything()) return 1;
  if (sees_nothing()) return 0;
  if (type_ == View::Type::kPolygon) return anchord::mass(density, polygon_, dims_);
  const MassPrecision precision(tolerance);
  const Vector3d mean = in_sensor(density.mean);
  const Depth at_mean = depth(mean);
  const auto& c = density.covariance;
  const double sphere = precision.clear * std::sqrt(c(0, 0) + c(1, 1) + (dims_ == 3 ? c(2, 2) : 0));
  if (at_mean.least() >= sphere) return 1;
  if (at_mean.least() <= -sphere) return 0;
  const Matrix3d covariance = rotation_.transpose() * c * rotation_;
  const Clearance clear = clearance(mean, covariance, at_mean, sphere, precision);
  if (clear.outside) return 0;
  if (clear.range && clear.bearing && clear.elevation) return 1;
  const Matrix2d flat = covariance.topLeftCorner<2, 2>();
  if (clear.range && clear.elevation)
    return wedge_mass(mean.head<2>(), flat, bearing_from_, bearing_width_);
  if (clear.range && clear.bearing && type_ == View::Type::kFrustum)
    return wedge_mass({mean.x(), mean.z()}, covariance({0, 2}, {0, 2}), elevation_min_,
                      elevation_max_ - elevation_min_);
  const double sum = dims_ == 2 ? flat_mass(mean.head<2>(), flat, precision)
                                : solid_mass(mean, covariance, clear.range, precision);
  return std::clamp(sum, 0.0, 1.0);
}

/// 2-D: over directions, with the integral of s N along each.
double MapView::flat_mass(const Vector2d& mean, const Matrix2d& covariance,
                          const MassPrecision& precision) const {
  const Matrix2d factor = upper_factor<2>(covariance);
  const WhitePlane plane(factor, solve_upper(factor, mean), precision.reach);
  const auto ray = [&](double theta) {
    const Vector2d v(std::cos(theta), std::sin(theta));
    const double stretch = (plane.factor * v).norm();
    const double off = v.x() * plane.mean.y() - v.y() * plane.mean.x();
    return std::exp(-off * off / 2) / (2 * kPi) *
           first_moment(v.dot(plane.mean), range_min_ / stretch, range_max_ / stretch);
  };
  return integrate_around(ray, plane.direction_of(bearing_from_),
                          plane.direction_of(bearing_from_ + bearing_width_), plane.peak,
                          plane.reach, precision.tolerance, 12);
}

}  // namespace anchord
