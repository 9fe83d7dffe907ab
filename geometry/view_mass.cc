#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/gaussian_mass.h"
#include "geometry/quadrature.h"
#include "geometry/standard_normal.h"
#include "geometry/view.h"

namespace anchord {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
/// A limit further from the mean than so many standard deviations does not cut (mass 1e-14).
constexpr double kClear = 8;
/// Directions further than this from the mean, in standard deviations, hold nothing (mass 1e-7).
constexpr double kReach = 5.7;
constexpr double kTolerance = 3e-7;
const double kRootTwoPi = std::sqrt(2 * kPi);

/// Integral of s exp(-(s - m)^2 / 2) from a to b.
double first_moment(double m, double a, double b) {
  const double t0 = a - m, t1 = b - m;
  return std::exp(-t0 * t0 / 2) - std::exp(-t1 * t1 / 2) + m * kRootTwoPi * normal_between(t0, t1);
}

/// Integral of s^2 exp(-(s - m)^2 / 2) from a to b.
double second_moment(double m, double a, double b) {
  const double t0 = a - m, t1 = b - m;
  return (a + m) * std::exp(-t0 * t0 / 2) - (b + m) * std::exp(-t1 * t1 / 2) +
         (1 + m * m) * kRootTwoPi * normal_between(t0, t1);
}

/// The plane seen from the sensor in coordinates where the density is standard normal about
/// `mean`: there direction theta is v = (cos theta, sin theta), and factor v in the sensor frame.
struct WhitePlane {
  Matrix2d factor;
  Vector2d mean;
  double peak, reach;  ///< directions that hold the density's mass: within reach of peak

  WhitePlane(const Matrix2d& upper_factor, const Vector2d& white_mean)
      : factor(upper_factor), mean(white_mean) {
    const double distance = mean.norm();
    peak = std::atan2(mean.y(), mean.x());
    reach = distance > kReach ? std::asin(kReach / distance) : kPi;
  }

  /// The direction of a bearing, growing with it without jumps; half turns stay half turns.
  double direction_of(double bearing) const {
    const double half_turns = std::floor(bearing / kPi);
    const double rest = bearing - half_turns * kPi;
    const Vector2d v = solve_upper(factor, {std::cos(rest), std::sin(rest)});
    return half_turns * kPi + std::atan2(std::max(v.y(), 0.0), v.x());
  }
};

/// Mass of a wedge with its tip at the sensor, from bearing `from` over `width`, without end.
double wedge_mass(const Vector2d& mean, const Matrix2d& covariance, double from, double width) {
  const Matrix2d factor = upper_factor<2>(covariance);
  const WhitePlane plane(factor, solve_upper(factor, mean));
  const double first = plane.direction_of(from), second = plane.direction_of(from + width);
  const Vector2d tip = -plane.mean;
  const double sum = (second - first) / (2 * kPi) +
                     ray_triangle_mass(tip, {std::cos(first), std::sin(first)}) -
                     ray_triangle_mass(tip, {std::cos(second), std::sin(second)});
  return std::clamp(sum, 0.0, 1.0);
}

}  // namespace

double MapView::mass(const Gaussian& density) const {
  if (sees_everything()) return 1;
  if (sees_nothing()) return 0;
  if (type_ == View::Type::kPolygon) return anchord::mass(density, polygon_, dims_);
  const Vector3d mean = in_sensor(density.mean);
  const Depth at_mean = depth(mean);
  const auto& c = density.covariance;
  const double clear = kClear * std::sqrt(c(0, 0) + c(1, 1) + (dims_ == 3 ? c(2, 2) : 0));
  if (at_mean.least() >= clear) return 1;
  if (at_mean.least() <= -clear) return 0;
  const Matrix3d covariance = rotation_.transpose() * c * rotation_;
  const Matrix2d flat = covariance.topLeftCorner<2, 2>();
  if (at_mean.range >= clear) {
    if (at_mean.elevation >= clear)
      return wedge_mass(mean.head<2>(), flat, bearing_from_, bearing_width_);
    if (type_ == View::Type::kFrustum && at_mean.bearing >= clear) {
      const Matrix2d upright = covariance({0, 2}, {0, 2});
      return wedge_mass({mean.x(), mean.z()}, upright, elevation_min_,
                        elevation_max_ - elevation_min_);
    }
  }
  const double sum = dims_ == 2 ? flat_mass(mean.head<2>(), flat) : solid_mass(mean, covariance);
  return std::clamp(sum, 0.0, 1.0);
}

/// 2-D: over directions, with the integral of s N along each.
double MapView::flat_mass(const Vector2d& mean, const Matrix2d& covariance) const {
  const Matrix2d factor = upper_factor<2>(covariance);
  const WhitePlane plane(factor, solve_upper(factor, mean));
  const auto ray = [&](double theta) {
    const Vector2d v(std::cos(theta), std::sin(theta));
    const double stretch = (plane.factor * v).norm();
    const double off = v.x() * plane.mean.y() - v.y() * plane.mean.x();
    return std::exp(-off * off / 2) / (2 * kPi) *
           first_moment(v.dot(plane.mean), range_min_ / stretch, range_max_ / stretch);
  };
  return integrate_around(ray, plane.direction_of(bearing_from_),
                          plane.direction_of(bearing_from_ + bearing_width_), plane.peak,
                          plane.reach, kTolerance, 12);
}

/// 3-D: over half-planes that hold the sensor's z axis, and in each over its directions, with the
/// integral of s^2 N along each.
double MapView::solid_mass(const Vector3d& mean, const Matrix3d& covariance) const {
  const Matrix3d whiten = upper_factor<3>(covariance).inverse();
  const Vector3d white_mean = whiten * mean;
  const Matrix2d flat_factor = upper_factor<2>(covariance.topLeftCorner<2, 2>());
  const WhitePlane ground(flat_factor, solve_upper(flat_factor, mean.head<2>()));
  const double scale = whiten.determinant() * flat_factor.determinant() / (2 * kPi * kRootTwoPi);
  const double inner_tolerance = kTolerance / (2 * ground.reach);

  const auto half_plane = [&](double ground_theta) {
    Vector2d forward = flat_factor * Vector2d(std::cos(ground_theta), std::sin(ground_theta));
    const double stretch = forward.norm();
    forward /= stretch;
    // The half-plane's axes, forward and up, in white coordinates, and its distance to the mean.
    const Vector3d white_forward = whiten.leftCols<2>() * forward, white_up = whiten.col(2);
    const Vector3d normal = white_forward.cross(white_up);
    const double area = normal.norm(), length = white_forward.norm();
    const double off = white_mean.dot(normal) / area;
    if (std::abs(off) > 2 * kReach) return 0.0;
    const Vector3d axis_x = white_forward / length, axis_y = normal.cross(axis_x) / area;
    // Within it: a white plane of its own; unfold is the inverse of its whitening.
    Matrix2d fold, unfold;
    fold << length, axis_x.dot(white_up), 0, area / length;
    unfold << 1 / length, -fold(0, 1) / area, 0, length / area;
    const WhitePlane plane(unfold, {white_mean.dot(axis_x), white_mean.dot(axis_y)});
    const auto direction_of = [&](const Vector2d& direction) {
      const Vector2d v = fold * direction;
      return std::atan2(v.y(), v.x());
    };
    Vector2d low(std::cos(elevation_min_), std::sin(elevation_min_));
    Vector2d high(std::cos(elevation_max_), std::sin(elevation_max_));
    if (type_ == View::Type::kFrustum) {
      low.y() *= forward.x();
      high.y() *= forward.x();
    }
    const auto ray = [&](double theta) {
      const Vector2d v(std::cos(theta), std::sin(theta));
      const Vector2d along_ray = unfold * v;
      const double reach = along_ray.norm();
      const double aside = v.x() * plane.mean.y() - v.y() * plane.mean.x();
      // d(area) is s ds d(theta); its distance from the z axis is s along_ray.x().
      return along_ray.x() * std::exp(-aside * aside / 2) *
             second_moment(v.dot(plane.mean), range_min_ / reach, range_max_ / reach);
    };
    const double jacobian = scale * std::exp(-off * off / 2) / (area * stretch * stretch);
    return jacobian * integrate_around(ray, direction_of(low), direction_of(high), plane.peak,
                                       plane.reach, inner_tolerance / jacobian, 12);
  };
  return integrate_around(half_plane, ground.direction_of(bearing_from_),
                          ground.direction_of(bearing_from_ + bearing_width_), ground.peak,
                          ground.reach, kTolerance, 12);
}

}  // namespace anchord
