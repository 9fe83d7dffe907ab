#include "geometry/polygon.h"

#include <algorithm>
#include <limits>

#include "geometry/region.h"

namespace anchord {
namespace {

/// The part of a polygon where a linear function is not negative (Sutherland and Hodgman 1974).
/// What falls apart stays joined by edges that go there and back, which have no area.
template <typename Function>
Polygon clipped(const Polygon& polygon, const Function& height) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = height(a), at_b = height(b);
    if (at_a >= 0) out.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) out.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return out;
}

/// How far `p` lies to the left of the line from `a` to `b`, times its length.
double left_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// The polygon counter-clockwise if it is convex, else nothing.
Polygon as_convex(Polygon polygon) {
  const std::size_t n = polygon.size();
  bool left = false, right = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = left_of(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  if (left && right) return {};
  if (right) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

}  // namespace

double area_of(const Polygon& polygon) { return polygon.size() < 3 ? 0.0 : Region{polygon}.area(); }

Polygon part_in(const Polygon& polygon, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  Polygon part = polygon;
  for (int axis = 0; axis < 2 && !part.empty(); ++axis) {
    part = clipped(part, [&](const Eigen::Vector2d& p) { return p[axis] - min[axis]; });
    part = clipped(part, [&](const Eigen::Vector2d& p) { return max[axis] - p[axis]; });
  }
  return part;
}

std::optional<Polygon> common_part(const Polygon& a, const Polygon& b) {
  Polygon convex = as_convex(a), part = b;
  if (convex.empty()) convex = as_convex(b), part = a;
  if (convex.empty()) return std::nullopt;
  for (std::size_t i = 0; i < convex.size() && !part.empty(); ++i)
    part = clipped(part, [&, &from = convex[i], &to = convex[(i + 1) % convex.size()]](
                             const Eigen::Vector2d& p) { return left_of(from, to, p); });
  return part;
}

// By Green's theorem over the edges, about a corner.
Gaussian moments_of(const Polygon& polygon) {
  const Eigen::Vector2d origin = polygon.front();
  double area = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - origin, b = polygon[(i + 1) % polygon.size()] - origin;
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross / 2;
    first += cross / 6 * (a + b);
    second += cross / 24 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
  Gaussian g;
  g.mean.head<2>() = first / area;
  g.covariance.topLeftCorner<2, 2>() = second / area - first * first.transpose() / (area * area);
  g.mean.head<2>() += origin;
  return g;
}

EdgeDistance edge_distance(const Eigen::Vector2d& point, const Polygon& polygon) {
  EdgeDistance out{std::numeric_limits<double>::infinity(), false};
  const Eigen::Vector2d* from = &polygon.back();
  for (const Eigen::Vector2d& to : polygon) {
    const Eigen::Vector2d edge = to - *from, d = point - *from;
    const double length2 = edge.squaredNorm();
    const double at = length2 > 0 ? std::clamp(d.dot(edge) / length2, 0.0, 1.0) : 0.0;
    out.distance2 = std::min(out.distance2, (d - at * edge).squaredNorm());
    if ((from->y() > point.y()) != (to.y() > point.y()) &&
        point.x() < from->x() + (point.y() - from->y()) / edge.y() * edge.x())
      out.inside = !out.inside;
    from = &to;
  }
  return out;
}

}  // namespace anchord
