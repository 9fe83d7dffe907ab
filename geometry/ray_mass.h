#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/standard_normal.h"

namespace anchord {

/// How closely a mass in view is wanted, and what follows from that, in standard deviations.
struct MassPrecision {
  double tolerance = 3e-7;  ///< of an integral
  double clear = 5.3;       ///< a limit further from the mean does not cut (mass 6e-8 for each)
  double outside = 4.9;     ///< what is further outside of one limit is not in view (mass 5e-7)
  double reach = 5.7;       ///< directions further from the mean hold nothing (mass 1e-7)

  /// Errors up to `wanted` do not matter. The mass beyond x is at most exp(-x^2 / 2) / 2.
  explicit MassPrecision(double wanted) {
    if (!(wanted > tolerance)) return;
    tolerance = std::min(wanted, 0.01);
    const auto beyond = [&](double share) {
      return std::sqrt(-2 * std::log(2 * share * tolerance));
    };
    clear = std::min(clear, beyond(0.2));
    outside = std::min(outside, beyond(1));
    reach = std::min(reach, beyond(0.3));
  }
};

/// The integral of s^n exp(-(s - m)^2 / 2) from a to b needs, with t = s - m: e^(-t^2/2) at the
/// ends, and the integral of that. What is beyond kEnd is left out; most rays have but one end.
struct RayPart {
  static constexpr double kEnd = 8;  ///< standard deviations; beyond there is nothing (1e-15)
  double at_start = 0, at_end = 0, between = 0;

  RayPart(double t0, double t1) {
    if (t0 >= kEnd || t1 <= -kEnd) return;
    double start = 2, end = 0;  // erfc
    if (t0 > -kEnd) at_start = std::exp(-t0 * t0 / 2), start = std::erfc(t0 / std::numbers::sqrt2);
    if (t1 < kEnd) at_end = std::exp(-t1 * t1 / 2), end = std::erfc(t1 / std::numbers::sqrt2);
    between = std::sqrt(std::numbers::pi / 2) * (start - end);
  }
};

/// Integral of s exp(-(s - m)^2 / 2) from a to b.
inline double first_moment(double m, double a, double b) {
  const RayPart part(a - m, b - m);
  return part.at_start - part.at_end + m * part.between;
}

/// Integral of s^2 exp(-(s - m)^2 / 2) from a to b.
inline double second_moment(double m, double a, double b) {
  const RayPart part(a - m, b - m);
  return (a + m) * part.at_start - (b + m) * part.at_end + (1 + m * m) * part.between;
}

/// A plane that holds the sensor in coordinates where the density is standard normal about `mean`:
/// there direction theta is v = (cos theta, sin theta), and factor v in the sensor's coordinates.
struct WhitePlane {
  Eigen::Matrix2d factor;
  Eigen::Vector2d mean;
  double peak, reach;  ///< directions that hold the density's mass: within reach of peak

  /// `deviations`: directions further than that from the mean hold nothing.
  WhitePlane(const Eigen::Matrix2d& upper_factor, const Eigen::Vector2d& white_mean,
             double deviations)
      : factor(upper_factor), mean(white_mean) {
    const double distance = mean.norm();
    peak = std::atan2(mean.y(), mean.x());
    reach = distance > deviations ? std::asin(deviations / distance) : std::numbers::pi;
  }

  /// The direction of a bearing, growing with it without jumps; half turns stay half turns.
  double direction_of(double bearing) const {
    const double half_turns = std::floor(bearing / std::numbers::pi);
    const double rest = bearing - half_turns * std::numbers::pi;
    const Eigen::Vector2d v = solve_upper(factor, {std::cos(rest), std::sin(rest)});
    return half_turns * std::numbers::pi + std::atan2(std::max(v.y(), 0.0), v.x());
  }
};

}  // namespace anchord
