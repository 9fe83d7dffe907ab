#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/result.h"

namespace anchord {

/// A prism in the map frame: a simple polygon (convex or not, either orientation) between two
/// heights, metres. In a 2-D world the heights are not looked at.
struct Region {
  std::vector<Eigen::Vector2d> polygon;
  double z_min = -std::numeric_limits<double>::infinity();
  double z_max = std::numeric_limits<double>::infinity();

  bool contains(const Eigen::Vector3d& point, int dims) const;
  /// Of the polygon, m^2.
  double area() const;
  /// m^dims; infinite for a 3-D prism without a floor or a ceiling.
  double volume(int dims) const;

  bool operator==(const Region&) const = default;
};

/// Most points that a polygon may have; the check for crossing edges is quadratic in them.
inline constexpr std::size_t kMaxPolygonPoints = 1000;

/// An axis-aligned box.
Region box(const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// Refuses a polygon with fewer than three points or more than kMaxPolygonPoints, a point that is
/// not finite, no area, or edges that cross or touch. `field` goes into the error.
Status check_polygon(const std::vector<Eigen::Vector2d>& polygon, const std::string& field);

}  // namespace anchord
