#include <algorithm>
#include <cmath>
#include <numbers>

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

/// The share of a small cell on the inner side of a limit: `depth` of its centre, `width` of the
/// cell across the limit.
double ramp(double depth, double width) {
  return width > 0 ? std::clamp(0.5 + depth / width, 0.0, 1.0) : (depth >= 0 ? 1.0 : 0.0);
}

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

  const int across = dims_ == 2 ? 4 : 2, up = dims_ == 2 ? 1 : 8;
  const Vector3d extent(size.x() / across, size.y() / across, size.z() / up);
  const Vector3d first = in_sensor(box_min + extent / 2);
  // Steps from cell to cell, in the sensor frame.
  const Vector3d step_x = rotation_.row(0).transpose() * extent.x();
  const Vector3d step_y = rotation_.row(1).transpose() * extent.y();
  const Vector3d step_z = rotation_.row(2).transpose() * extent.z();
  double sum = 0;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j)
      for (int k = 0; k < up; ++k)
        sum += cell_share(first + i * step_x + j * step_y + k * step_z, extent);
  return sum / (across * across * up);
}

/// The share of a small box about p (sensor frame), each limit taken as a plane.
double MapView::cell_share(const Vector3d& p, const Vector3d& extent) const {
  const Depth at = depth(p);
  const double half_diagonal = extent.norm() / 2;
  if (at.least() >= half_diagonal) return 1;
  if (at.least() <= -half_diagonal) return 0;
  // Of the box, along a unit vector of the sensor frame.
  const auto width = [&](const Vector3d& normal) {
    return (rotation_ * normal).cwiseAbs().dot(extent);
  };
  double share = 1;
  if (at.range < half_diagonal) {
    const double distance = p.norm();
    const double across = width(p / std::max(distance, 1e-12));
    share *= ramp(range_max_ - distance, across);
    if (range_min_ > 0) share *= ramp(distance - range_min_, across);
  }
  if (!all_bearings_ && at.bearing < half_diagonal) {
    const double a = ramp(bearing_normal_[0].dot(p), width(bearing_normal_[0]));
    const double b = ramp(bearing_normal_[1].dot(p), width(bearing_normal_[1]));
    share *= bearing_width_ <= std::numbers::pi ? a * b : 1 - (1 - a) * (1 - b);
  }
  if (at.elevation < half_diagonal) {
    const double flat = along(p);
    Vector3d outward = Vector3d::UnitX();
    if (type_ == View::Type::kSector) outward = Vector3d(p.x(), p.y(), 0) / std::max(flat, 1e-12);
    const auto inside = [&](const Vector2d& normal) {
      return ramp(normal.dot(Vector2d(flat, p.z())),
                  width(normal.x() * outward + normal.y() * Vector3d::UnitZ()));
    };
    if (has_floor_) share *= inside(floor_normal_);
    if (has_ceiling_) share *= inside(ceiling_normal_);
  }
  return share;
}

/// Exact: the area of the polygon clipped to the box (Sutherland, Hodgman, 1974).
double MapView::polygon_share(const Vector3d& box_min, const Vector3d& box_max) const {
  Region part{polygon_.polygon};
  for (int axis = 0; axis < 2 && !part.polygon.empty(); ++axis) {
    part.polygon = clip(part.polygon, axis, box_min[axis], true);
    if (!part.polygon.empty()) part.polygon = clip(part.polygon, axis, box_max[axis], false);
  }
  if (part.polygon.empty()) return 0;
  const double area = (box_max - box_min).head<2>().prod();
  const double share = part.area() / area;
  // Rounding must not keep a cell that is wholly seen from being so.
  return share > 1 - 1e-9 ? 1 : share;
}

}  // namespace anchord
