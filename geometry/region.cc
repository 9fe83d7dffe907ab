#include "geometry/region.h"

#include <algorithm>
#include <cmath>

namespace anchord {
namespace {

using Point = Eigen::Vector2d;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Twice the signed area, about the first point to keep the digits of a polygon far out.
double twice_area(const std::vector<Point>& polygon) {
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return sum;
}

/// Whether c, known to be on the line through a and b, lies between them.
bool between(const Point& a, const Point& b, const Point& c) { return (c - a).dot(c - b) <= 0; }

bool segments_touch(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) ||
      std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
      std::max(a.y(), b.y()) < std::min(c.y(), d.y()) ||
      std::max(c.y(), d.y()) < std::min(a.y(), b.y()))
    return false;
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  if (((c_side > 0) != (d_side > 0)) && ((a_side > 0) != (b_side > 0)) && c_side != 0 &&
      d_side != 0 && a_side != 0 && b_side != 0)
    return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) ||
         (a_side == 0 && between(c, d, a)) || (b_side == 0 && between(c, d, b));
}

/// Whether the edge b-c runs back along a-b.
bool folds_back(const Point& a, const Point& b, const Point& c) {
  return cross(b - a, c - b) == 0 && (b - a).dot(c - b) < 0;
}

}  // namespace

bool Region::contains(const Eigen::Vector3d& point, int dims) const {
  if (dims == 3 && !(point.z() >= z_min && point.z() <= z_max)) return false;
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Point &a = polygon[i], &b = polygon[j];
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

double Region::area() const { return std::abs(twice_area(polygon)) / 2; }

double Region::volume(int dims) const { return dims == 2 ? area() : area() * (z_max - z_min); }

Region box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  return {{{min.x(), min.y()}, {max.x(), min.y()}, {max.x(), max.y()}, {min.x(), max.y()}},
          min.z(),
          max.z()};
}

Status check_polygon(const std::vector<Point>& polygon, const std::string& field) {
  if (polygon.size() < 3) return invalid(field, "a polygon needs at least three points");
  if (polygon.size() > kMaxPolygonPoints)
    return invalid(field, "a polygon has at most " + std::to_string(kMaxPolygonPoints) + " points");
  std::vector<Point> points;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (!polygon[i].allFinite())
      return invalid(field + "[" + std::to_string(i) + "]", "must be two finite numbers");
    if (points.empty() || polygon[i] != points.back()) points.push_back(polygon[i]);
  }
  if (points.size() > 1 && points.front() == points.back()) points.pop_back();
  const double area = std::abs(twice_area(points)) / 2;
  if (!(area > 0) || !std::isfinite(area))
    return invalid(field, "the polygon must have a finite area above 0");
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = points[i], &b = points[(i + 1) % n];
    bool crossing = folds_back(a, b, points[(i + 2) % n]);
    // Every edge that is no neighbour of this one.
    for (std::size_t j = i + 2; j < n && !(i == 0 && j == n - 1) && !crossing; ++j)
      crossing = segments_touch(a, b, points[j], points[(j + 1) % n]);
    if (crossing)
      return invalid(
          field, "the polygon's edges must not cross or touch (edge " + std::to_string(i) + ")");
  }
  return Done{};
}

}  // namespace anchord
