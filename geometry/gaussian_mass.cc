#include "geometry/gaussian_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/polygon.h"
#include "geometry/quadrature.h"
#include "geometry/standard_normal.h"

namespace anchord {
namespace {

/// Beyond so many standard deviations there is nothing (mass 1e-18).
constexpr double kFar = 9;
/// Within so many is all of it (but 3e-12).
constexpr double kAll = 7;

struct Bounds {
  Eigen::Vector2d min, max;
};

Bounds bounds_of(const std::vector<Eigen::Vector2d>& polygon) {
  Bounds bounds{polygon.front(), polygon.front()};
  for (const auto& point : polygon) {
    bounds.min = bounds.min.cwiseMin(point);
    bounds.max = bounds.max.cwiseMax(point);
  }
  return bounds;
}

/// Mass of the polygon, given the upper factor of the covariance.
double polygon_mass(const Eigen::Vector2d& mean, const Eigen::Matrix2d& factor,
                    const std::vector<Eigen::Vector2d>& polygon) {
  double sum = 0;
  Eigen::Vector2d from = solve_upper(factor, polygon.back() - mean);
  for (const auto& point : polygon) {
    const Eigen::Vector2d to = solve_upper(factor, point - mean);
    sum += triangle_mass(from, to);
    from = to;
  }
  return std::clamp(std::abs(sum), 0.0, 1.0);
}

}  // namespace

double mass(const Gaussian& density, const Region& region, int dims) {
  if (region.polygon.size() < 3) return 0;
  const Bounds bounds = bounds_of(region.polygon);
  const Eigen::Vector2d mean = density.mean.head<2>();
  const Eigen::Matrix2d covariance = density.covariance.topLeftCorner<2, 2>();
  const double reach_x = kFar * std::sqrt(covariance(0, 0)) + 1e-8;
  const double reach_y = kFar * std::sqrt(covariance(1, 1)) + 1e-8;
  if (mean.x() + reach_x < bounds.min.x() || mean.x() - reach_x > bounds.max.x() ||
      mean.y() + reach_y < bounds.min.y() || mean.y() - reach_y > bounds.max.y())
    return 0;
  // Most densities are narrow and stand far from every edge.
  const EdgeDistance edge = edge_distance(mean, region.polygon);
  const bool apart = edge.distance2 > kAll * kAll * covariance.trace();
  if (apart && !edge.inside) return 0;
  if (dims == 2) return apart ? 1 : polygon_mass(mean, upper_factor<2>(covariance), region.polygon);

  const double variance = std::max(density.covariance(2, 2), 1e-18), sigma = std::sqrt(variance);
  double low = std::max((region.z_min - density.mean.z()) / sigma, -kFar);
  double high = std::min((region.z_max - density.mean.z()) / sigma, kFar);
  if (low >= high) return 0;
  if (apart) return normal_between(low, high);
  const Eigen::Vector2d slope = density.covariance.block<2, 1>(0, 2) / sigma;
  const bool all_heights = low == -kFar && high == kFar;
  const bool correlated = slope.cwiseAbs2().sum() > 1e-28 * covariance.trace();
  if (all_heights || !correlated)
    return polygon_mass(mean, upper_factor<2>(covariance), region.polygon) *
           (all_heights ? 1.0 : normal_between(low, high));

  // Given u = (z - mean) / sigma, the rest has mean + slope u and this covariance:
  const Eigen::Matrix2d given_z = covariance - slope * slope.transpose();
  const Eigen::Matrix2d factor = upper_factor<2>(given_z);
  // Only heights where that reaches the polygon's bounds matter.
  for (int axis = 0; axis < 2; ++axis) {
    if (slope[axis] == 0) continue;
    const double reach = kFar * std::sqrt(std::max(given_z(axis, axis), 0.0)) + 1e-8;
    const double a = (bounds.min[axis] - reach - mean[axis]) / slope[axis];
    const double b = (bounds.max[axis] + reach - mean[axis]) / slope[axis];
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  if (low >= high) return 0;
  const double scale = 1 / std::sqrt(2 * std::numbers::pi);
  const auto at_height = [&](double u) {
    return scale * std::exp(-u * u / 2) * polygon_mass(mean + slope * u, factor, region.polygon);
  };
  const int panels = std::max(1, static_cast<int>(std::ceil((high - low) / 2)));
  double sum = 0;
  for (int i = 0; i < panels; ++i)
    sum += integrate(at_height, low + (high - low) * i / panels,
                     low + (high - low) * (i + 1) / panels, 1e-9 / panels, 16);
  return std::clamp(sum, 0.0, 1.0);
}

}  // namespace anchord
