#include "perception/task_check.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "geometry/region.h"

namespace anchord {

namespace {

constexpr double kFarthest = 1e6;      ///< m, of a coordinate
constexpr double kMostRadius = 100;    ///< standard deviations
constexpr double kMostVariance = 1e8;  ///< m^2
constexpr double kLargest = 1000;      ///< m, of an object
constexpr double kSymmetric = 1e-6;    ///< relative

bool small(double x) { return std::abs(x) <= kFarthest; }  // false for NaN

/// The leading block; in a 2-D world with a variance of its own for the height.
Eigen::Matrix3d used_covariance(const RegionOfInterest& region, int dims) {
  Eigen::Matrix3d c = Eigen::Map<const Eigen::Matrix3d>(region.covariance.data());
  if (dims == 2) {
    c.row(2).setZero();
    c.col(2).setZero();
    c(2, 2) = 1;
  }
  return c;
}

Status check_ellipsoid(const RegionOfInterest& region, int dims, const std::string& field) {
  for (int i = 0; i < dims; ++i) {
    if (!small(region.center[static_cast<std::size_t>(i)])) {
      return invalid(field + ".center", "is not a place");
    }
  }
  if (!(region.radius > 0 && region.radius <= kMostRadius)) {
    return invalid(field + ".radius", "must lie in 0 to 100 standard deviations");
  }
  const Eigen::Matrix3d c = used_covariance(region, dims);
  if (!c.allFinite() || c.cwiseAbs().maxCoeff() > kMostVariance ||
      (c - c.transpose()).cwiseAbs().maxCoeff() > kSymmetric * c.cwiseAbs().maxCoeff() ||
      Eigen::LLT<Eigen::Matrix3d>(c).info() != Eigen::Success) {
    return invalid(field + ".covariance", "is not symmetric positive definite");
  }
  return Done{};
}

Status check_prism(const RegionOfInterest& region, int dims, const std::string& field) {
  if (region.polygon.size() < 3) return invalid(field + ".polygon", "has fewer than three points");
  for (const auto& point : region.polygon) {
    if (!small(point[0]) || !small(point[1])) {
      return invalid(field + ".polygon", "has a point that is not a place");
    }
  }
  if (dims == 3 && !(small(region.z[0]) && small(region.z[1]) && region.z[0] < region.z[1])) {
    return invalid(field + ".z", "must be two heights, the lower one first");
  }
  return Done{};
}

}  // namespace

Status check_task(const Task& task, int dims) {
  if (task.object.empty()) return invalid("object", "is missing");
  for (const double side : task.extent) {
    if (!(side >= 0 && side <= kLargest)) return invalid("extent", "is not a size");
  }
  if (task.regions.empty()) return invalid("regions", "are missing");
  if (task.regions.size() > kMaxRegions) return invalid("regions", "are too many");
  std::size_t corners = 0;
  for (std::size_t i = 0; i < task.regions.size(); ++i) {
    const RegionOfInterest& region = task.regions[i];
    const std::string field = "regions[" + std::to_string(i) + "]";
    if (!(region.p > 0 && region.p <= 1)) return invalid(field + ".p", "is not a probability");
    const Status status = region.kind == RegionOfInterest::Kind::kPrism
                              ? check_prism(region, dims, field)
                              : check_ellipsoid(region, dims, field);
    if (!status) return status;
    corners += region.polygon.size();
  }
  // A place as large as a configuration may have, and rows of cells.
  if (corners > kMaxPolygonPoints + 3 * kMaxRegions)
    return invalid("regions", "have too many corners");
  return Done{};
}

}  // namespace anchord
