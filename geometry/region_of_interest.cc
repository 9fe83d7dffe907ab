#include "geometry/region_of_interest.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "geometry/conversion.h"

namespace anchord {
namespace {

constexpr int kSides = 48;

}  // namespace

Region prism_of(const RegionOfInterest& roi) {
  Region region;
  if (roi.kind == RegionOfInterest::Kind::kPrism) {
    for (const auto& [x, y] : roi.polygon) region.polygon.emplace_back(x, y);
    region.z_min = roi.z[0];
    region.z_max = roi.z[1];
    return region;
  }
  Eigen::Matrix2d shadow;
  shadow << roi.covariance[0], roi.covariance[1], roi.covariance[3], roi.covariance[4];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(shadow);
  const Eigen::Matrix2d root =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  // A regular polygon around the unit circle that has its area.
  const double step = 2 * std::numbers::pi / kSides;
  const double corner = std::sqrt(step / std::sin(step));
  for (int i = 0; i < kSides; ++i) {
    const Eigen::Vector2d on_circle(std::cos(i * step), std::sin(i * step));
    region.polygon.push_back(Eigen::Vector2d(roi.center[0], roi.center[1]) +
                             roi.radius * corner * root * on_circle);
  }
  const double half = roi.radius * std::sqrt(std::max(roi.covariance[8], 0.0));
  region.z_min = roi.center[2] - half;
  region.z_max = roi.center[2] + half;
  return region;
}

Status check_region(const RegionOfInterest& roi, int dims, const std::string& field) {
  if (!std::isfinite(roi.p) || roi.p < 0 || roi.p > 1)
    return invalid(field + ".p", "must be a probability");
  if (roi.kind == RegionOfInterest::Kind::kPrism) {
    std::vector<Eigen::Vector2d> polygon;
    for (const auto& [x, y] : roi.polygon) polygon.emplace_back(x, y);
    if (Status good = check_polygon(polygon, field + ".polygon"); !good) return good;
    if (dims == 3 && !(std::isfinite(roi.z[0]) && std::isfinite(roi.z[1]) && roi.z[0] < roi.z[1]))
      return invalid(field + ".z", "must be two heights, the lower one first");
    return Done{};
  }
  CartesianMeasurement ellipsoid;
  for (int i = 0; i < dims; ++i) {
    ellipsoid.position.push_back(roi.center[i]);
    for (int j = 0; j < dims; ++j) ellipsoid.covariance.push_back(roi.covariance[3 * i + j]);
  }
  if (const auto good = to_map(ellipsoid, std::nullopt, dims); !good) {
    Error why = good.error();
    why.field = field + (why.field == "position" ? ".center" : "." + why.field);
    return why;
  }
  if (!std::isfinite(roi.radius) || roi.radius <= 0)
    return invalid(field + ".radius", "must be above 0");
  return Done{};
}

}  // namespace anchord
