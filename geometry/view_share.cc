#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "geometry/polygon.h"
#include "geometry/view.h"

namespace anchord {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The part of the polygon where coordinate `axis` is above `limit` (or below it).
std::vector<Vector2d> clip(const std::vector<Vector2d>& polygon, int axis, double limit,
                           bool above) {
  std::vector<Vector2d> kept;
  const auto inside = [&](const Vector2d& p) { return (p[axis] > limit) == above; };
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vector2d &from = polygon[j], &to = polygon[i];
    if (inside(from) != inside(to))
      kept.push_back(from + (to - from) * ((limit - from[axis]) / (to[axis] - from[axis])));
    if (inside(to)) kept.push_back(to);
  }
  return kept;
}

/// A box of the map as small cells in the sensor frame: the first one's centre, and a column per
/// axis of the box, from each to the next.
struct SmallCells {
  Vector3d first;
  Eigen::Matrix3d step;
  Eigen::Vector3i count;

  Vector3d at(const Vector3d& ijk) const { return first + step * ijk; }
  /// Of one of them along a unit vector.
  double width(const Vector3d& normal) const {
    return (step.transpose() * normal).cwiseAbs().sum();
  }
};

/// The share of a small cell on the inner side of a limit: `depth` of its centre, `width` of the
/// cell across the limit.
double ramp(double depth, double width) {
  return width > 0 ? std::clamp(0.5 + depth / width, 0.0, 1.0) : (depth >= 0 ? 1.0 : 0.0);
}

/// A plane through the sensor as a limit of a box's small cells.
struct Plane {
  double first = 0;  ///< depth of the first one's centre
  Vector3d step = Vector3d::Zero();
  double width = 0;

  Plane() = default;
  Plane(const SmallCells& cells, const Vector3d& normal)
      : first(normal.dot(cells.first)),
        step(cells.step.transpose() * normal),
        width(step.cwiseAbs().sum()) {}

  double share(const Vector3d& ijk) const { return ramp(first + step.dot(ijk), width); }
  /// Whether all of the box is beyond it.
  bool beyond(const SmallCells& cells) const {
    const Vector3d last = (cells.count.array() - 1).matrix().cast<double>();
    return first + step.cwiseMax(0).dot(last) + width / 2 <= 0;
  }
};

}  // namespace

double MapView::share(const Vector3d& box_min, const Vector3d& box_max) const {
  if (sees_everything()) return 1;
  if (sees_nothing()) return 0;
  if (box_max.x() < bounds_[0] || box_max.y() < bounds_[1] || box_min.x() > bounds_[2] ||
      box_min.y() > bounds_[3])
    return 0;
  if (type_ == View::Type::kPolygon) return polygon_share(box_min, box_max);
  Vector3d size = box_max - box_min;
  if (dims_ == 2) size.z() = 0;
  const double centre_depth = depth(in_sensor((box_min + box_max) / 2)).least();
  const double half_diagonal = size.norm() / 2;
  if (centre_depth >= half_diagonal) return 1;
  if (centre_depth <= -half_diagonal) return 0;
  return sampled_share(box_min, size);
}

/// By small cells, each limit taken as a plane where it cuts one.
double MapView::sampled_share(const Vector3d& box_min, const Vector3d& size) const {
  SmallCells cells;
  cells.count = dims_ == 2 ? Eigen::Vector3i(4, 4, 1) : Eigen::Vector3i(2, 2, 8);
  const Vector3d extent = size.cwiseQuotient(cells.count.cast<double>());
  cells.first = in_sensor(box_min + extent / 2);
  cells.step = rotation_.transpose() * extent.asDiagonal();
  const double half_diagonal = extent.norm() / 2;

  // All of these must hold; of the bearing's two sides one, where it is more than half a turn.
  std::array<Plane, 4> planes;
  std::size_t n = 0;
  const bool either_side = bearing_width_ > std::numbers::pi;
  if (!all_bearings_ && !either_side)
    for (const Vector3d& normal : bearing_normal_) planes[n++] = Plane(cells, normal);
  const bool flat_elevation = type_ == View::Type::kFrustum;
  if (has_floor_ && flat_elevation)
    planes[n++] = Plane(cells, {floor_normal_.x(), 0, floor_normal_.y()});
  if (has_ceiling_ && flat_elevation)
    planes[n++] = Plane(cells, {ceiling_normal_.x(), 0, ceiling_normal_.y()});
  const std::span<const Plane> all(planes.data(), n);
  if (std::ranges::any_of(all, [&](const Plane& plane) { return plane.beyond(cells); })) return 0;
  std::array<Plane, 2> sides;
  if (!all_bearings_ && either_side)
    for (int i = 0; i < 2; ++i) sides[i] = Plane(cells, bearing_normal_[i]);

  const double surely_far = std::max(range_max_ - half_diagonal, 0.0);
  const double surely_near = range_min_ > 0 ? range_min_ + half_diagonal : 0;
  const auto cell_share = [&](const Vector3d& ijk) {
    double share = 1;
    for (const Plane& plane : all)
      if ((share *= plane.share(ijk)) == 0) return 0.0;
    if (!all_bearings_ && either_side)
      share *= 1 - (1 - sides[0].share(ijk)) * (1 - sides[1].share(ijk));
    const Vector3d p = cells.at(ijk);
    const double distance2 = p.squaredNorm();
    if (distance2 > surely_far * surely_far || distance2 < surely_near * surely_near) {
      const double distance = std::sqrt(distance2);
      const double across = cells.width(p / std::max(distance, 1e-12));
      share *= ramp(range_max_ - distance, across);
      if (range_min_ > 0) share *= ramp(distance - range_min_, across);
    }
    if (!flat_elevation && (has_floor_ || has_ceiling_)) {
      const double flat = p.head<2>().norm();
      const Vector3d outward = Vector3d(p.x(), p.y(), 0) / std::max(flat, 1e-12);
      const auto inside = [&](const Vector2d& normal) {
        return ramp(normal.dot(Vector2d(flat, p.z())),
                    cells.width(normal.x() * outward + normal.y() * Vector3d::UnitZ()));
      };
      if (has_floor_) share *= inside(floor_normal_);
      if (has_ceiling_) share *= inside(ceiling_normal_);
    }
    return share;
  };
  double sum = 0;
  for (int i = 0; i < cells.count.x(); ++i)
    for (int j = 0; j < cells.count.y(); ++j)
      for (int k = 0; k < cells.count.z(); ++k) sum += cell_share(Vector3d(i, j, k));
  return sum / cells.count.prod();
}

/// Exact: the area of the polygon clipped to the box (Sutherland, Hodgman, 1974).
double MapView::polygon_share(const Vector3d& box_min, const Vector3d& box_max) const {
  const Vector2d size = (box_max - box_min).head<2>();
  const EdgeDistance edge = edge_distance(box_min.head<2>() + size / 2, polygon_.polygon);
  if (4 * edge.distance2 > size.squaredNorm()) return edge.inside ? 1 : 0;
  Region part{polygon_.polygon};
  for (int axis = 0; axis < 2 && !part.polygon.empty(); ++axis) {
    part.polygon = clip(part.polygon, axis, box_min[axis], true);
    if (!part.polygon.empty()) part.polygon = clip(part.polygon, axis, box_max[axis], false);
  }
  if (part.polygon.empty()) return 0;
  const double share = part.area() / size.prod();
  // Rounding must not keep a cell that is wholly seen from being so.
  return share > 1 - 1e-9 ? 1 : share;
}

}  // namespace anchord
