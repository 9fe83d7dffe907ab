#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/gaussian.h"

namespace anchord {

/// Corners of a polygon in the plane of the map, metres.
using Polygon = std::vector<Eigen::Vector2d>;

/// Area, whichever way round; 0 for fewer than three corners.
double area_of(const Polygon& polygon);

/// The part of a polygon in an axis-parallel rectangle (heights are not looked at). What falls
/// apart stays joined by edges that go there and back, which have no area.
Polygon part_in(const Polygon& polygon, const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// What two polygons have in common, if one of them is convex.
std::optional<Polygon> common_part(const Polygon& a, const Polygon& b);

/// Mean and covariance of the uniform density over a polygon with an area, in the plane.
Gaussian moments_of(const Polygon& polygon);

/// How far a point is from a polygon's edge, squared, m^2; and on which side.
struct EdgeDistance {
  double distance2;
  bool inside;
};
EdgeDistance edge_distance(const Eigen::Vector2d& point, const Polygon& polygon);

}  // namespace anchord
