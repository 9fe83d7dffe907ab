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
/// A limit further from the mean than so many standard deviations does not cut (mass 6e-8 each).
constexpr double kClear = 5.3;
/// What is further outside of one is outside of all (mass 5e-7).
constexpr double kOutside = 4.9;
/// Along a ray, beyond so many standard deviations there is nothing (1e-15).
constexpr double kEnd = 8;
/// Directions further than this from the mean, in standard deviations, hold nothing (mass 1e-7).
constexpr double kReach = 5.7;
constexpr double kTolerance = 3e-7;
const double kRootTwoPi = std::sqrt(2 * kPi);

/// The integral of s^n exp(-(s - m)^2 / 2) from a to b needs, with t = s - m: e^(-t^2/2) at the
/// ends, and the integral of that. What is beyond kEnd is left out; most rays have but one end.
struct RayPart {
  double at_start = 0, at_end = 0, between = 0;

  RayPart(double t0, double t1) {
    if (t0 >= kEnd || t1 <= -kEnd) return;
    double start = 2, end = 0;  // erfc
    if (t0 > -kEnd) at_start = std::exp(-t0 * t0 / 2), start = std::erfc(t0 / std::numbers::sqrt2);
    if (t1 < kEnd) at_end = std::exp(-t1 * t1 / 2), end = std::erfc(t1 / std::numbers::sqrt2);
    between = kRootTwoPi / 2 * (start - end);
  }
};

/// Integral of s exp(-(s - m)^2 / 2) from a to b.
double first_moment(double m, double a, double b) {
  const RayPart part(a - m, b - m);
  return part.at_start - part.at_end + m * part.between;
}

/// Integral of s^2 exp(-(s - m)^2 / 2) from a to b.
double second_moment(double m, double a, double b) {
  const RayPart part(a - m, b - m);
  return (a + m) * part.at_start - (b + m) * part.at_end + (1 + m * m) * part.between;
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

/// Integral of c.p exp(-|p - mean|^2 / 2) over the directions from `first` to `second`: the mean's
/// share, and by the divergence theorem what the two rays cut off.
double wedge_moment(const WhitePlane& plane, const Vector2d& c, double first, double second) {
  const auto edge = [&](double theta, double& share) {
    const Vector2d v(std::cos(theta), std::sin(theta));
    share = ray_triangle_mass(-plane.mean, v);
    const double off = v.x() * plane.mean.y() - v.y() * plane.mean.x();
    const double on_ray = std::exp(-off * off / 2) * kRootTwoPi / 2 *
                          std::erfc(-v.dot(plane.mean) / std::numbers::sqrt2);
    return on_ray * (c.x() * v.y() - c.y() * v.x());
  };
  double share_first, share_second;
  const double cut = edge(second, share_second) - edge(first, share_first);
  const double mass = second - first + 2 * kPi * (share_first - share_second);
  return c.dot(plane.mean) * mass + cut;
}

}  // namespace

/// Where a density stands against the limits, looking at its spread across each of them. A sphere
/// of kClear standard deviations has been tried before; this sharpens what it left open.
MapView::Clearance MapView::clearance(const Vector3d& mean, const Matrix3d& covariance,
                                      const Depth& at_mean, double sphere) const {
  const auto deviation = [&](const Vector3d& normal) {
    return std::sqrt(std::max(normal.dot(covariance * normal), 0.0));
  };
  Clearance clear{at_mean.range >= sphere, at_mean.bearing >= sphere, at_mean.elevation >= sphere,
                  false};
  if (!clear.range) {
    const double distance = mean.norm();
    const double sigma = deviation(mean / std::max(distance, 1e-12)), radial = kClear * sigma;
    const double across = std::max(sphere * sphere - radial * radial, 0.0);
    const double farthest = std::sqrt((distance + radial) * (distance + radial) + across);
    clear.range = farthest <= range_max_ && (range_min_ == 0 || distance - radial >= range_min_);
    clear.outside = distance - kOutside * sigma >= range_max_;
  }
  if (!clear.bearing) {
    bool inside[2], outside[2];
    for (int i = 0; i < 2; ++i) {
      const double depth = bearing_normal_[i].dot(mean), sigma = deviation(bearing_normal_[i]);
      inside[i] = depth >= kClear * sigma;
      outside[i] = depth <= -kOutside * sigma;
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
          depth >= sphere || ((planes || normal.x() >= 0) && depth >= kClear * sigma);
      clear.outside |= (planes || normal.x() <= 0) && depth <= -kOutside * sigma;
    };
    if (has_floor_) test(floor_normal_);
    if (has_ceiling_) test(ceiling_normal_);
  }
  return clear;
}

double MapView::mass(const Gaussian& density) const {
  if (sees_everything()) return 1;
  if (sees_nothing()) return 0;
  if (type_ == View::Type::kPolygon) return anchord::mass(density, polygon_, dims_);
  const Vector3d mean = in_sensor(density.mean);
  const Depth at_mean = depth(mean);
  const auto& c = density.covariance;
  const double sphere = kClear * std::sqrt(c(0, 0) + c(1, 1) + (dims_ == 3 ? c(2, 2) : 0));
  if (at_mean.least() >= sphere) return 1;
  if (at_mean.least() <= -sphere) return 0;
  const Matrix3d covariance = rotation_.transpose() * c * rotation_;
  const Clearance clear = clearance(mean, covariance, at_mean, sphere);
  if (clear.outside) return 0;
  if (clear.range && clear.bearing && clear.elevation) return 1;
  const Matrix2d flat = covariance.topLeftCorner<2, 2>();
  if (clear.range && clear.elevation)
    return wedge_mass(mean.head<2>(), flat, bearing_from_, bearing_width_);
  if (clear.range && clear.bearing && type_ == View::Type::kFrustum)
    return wedge_mass({mean.x(), mean.z()}, covariance({0, 2}, {0, 2}), elevation_min_,
                      elevation_max_ - elevation_min_);
  const double sum =
      dims_ == 2 ? flat_mass(mean.head<2>(), flat) : solid_mass(mean, covariance, clear.range);
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
double MapView::solid_mass(const Vector3d& mean, const Matrix3d& covariance, bool any_range) const {
  const Matrix3d whiten = upper_factor<3>(covariance).inverse();
  const Vector3d white_mean = whiten * mean;
  const Matrix2d flat_factor = upper_factor<2>(covariance.topLeftCorner<2, 2>());
  const WhitePlane ground(flat_factor, solve_upper(flat_factor, mean.head<2>()));
  const double scale = whiten.determinant() * flat_factor.determinant() / (2 * kPi * kRootTwoPi);
  const double inner_tolerance = kTolerance / (2 * ground.reach);
  const double least = 0.1 * inner_tolerance;

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
    Matrix2d fold, unfold;
    fold << length, axis_x.dot(white_up), 0, area / length;
    unfold << 1 / length, -fold(0, 1) / area, 0, length / area;
    const WhitePlane plane(unfold, {white_mean.dot(axis_x), white_mean.dot(axis_y)});
    const double jacobian = scale * std::exp(-off * off / 2) / (area * stretch * stretch);
    // All that the half-plane may hold: its points' distance from the z axis is unfold.row(0) p.
    const double outward = std::abs(unfold.row(0).dot(plane.mean)) + unfold.row(0).norm();
    if (2 * kPi * jacobian * outward < least) return 0.0;
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
    const double farthest = (unfold * plane.mean).norm() + kClear * unfold.norm();
    if (any_range || (range_min_ == 0 && farthest <= range_max_))
      return jacobian * wedge_moment(plane, unfold.row(0), direction_of(low), direction_of(high));
    return jacobian * integrate_around(ray, direction_of(low), direction_of(high), plane.peak,
                                       plane.reach, inner_tolerance / jacobian, 12);
  };
  return integrate_around(half_plane, ground.direction_of(bearing_from_),
                          ground.direction_of(bearing_from_ + bearing_width_), ground.peak,
                          ground.reach, kTolerance, 12);
}

}  // namespace anchord
