#include "geometry/view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/conversion.h"
#include "geometry/rotation.h"

namespace anchord {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Status check_interval(const std::array<double, 2>& interval, const char* field) {
  if (!std::isfinite(interval[0]) || !std::isfinite(interval[1]))
    return invalid(field, "must be two finite numbers");
  if (interval[0] >= interval[1])
    return invalid(field, "the first number must be below the second");
  return Done{};
}

Status check_opening(double angle, const char* field) {
  if (!(angle > 0 && angle < kPi)) return invalid(field, "must be above 0 and below pi");
  return Done{};
}

}  // namespace

Result<MapView> MapView::place(const View& view, const std::optional<Pose>& pose, int dims) {
  MapView placed;
  placed.type_ = view.type;
  placed.dims_ = dims;
  if (pose) {
    if (Status status = check_pose(*pose); !status) return status.error();
    placed.origin_ = {pose->position[0], pose->position[1], dims == 2 ? 0 : pose->position[2]};
    placed.rotation_ = dims == 2 ? level(rotation_of(*pose)) : rotation_of(*pose);
  }
  Status status = Done{};
  switch (view.type) {
    case View::Type::kNone:
      return placed;
    case View::Type::kWorld:
      placed.bounds_ = {-kInfinity, -kInfinity, kInfinity, kInfinity};
      return placed;
    case View::Type::kSector:
      status = placed.set_sector(view);
      break;
    case View::Type::kFrustum:
      status = placed.set_frustum(view);
      break;
    case View::Type::kPolygon:
      status = placed.set_polygon(view);
      break;
    default:
      return invalid("view.type", "must be none, world, sector, frustum or polygon");
  }
  if (!status) return status.error();
  return placed;
}

Status MapView::set_range(const View& view) {
  if (Status status = check_interval(view.range, "view.range"); !status) return status;
  if (view.range[0] < 0) return invalid("view.range", "must not be negative");
  range_min_ = view.range[0];
  range_max_ = view.range[1];
  bounds_ = reach();
  return Done{};
}

void MapView::set_bearing(double from, double width) {
  bearing_from_ = std::remainder(from, 2 * kPi);
  all_bearings_ = width >= 2 * kPi;
  bearing_width_ = std::min(width, 2 * kPi);
  const double to = bearing_from_ + bearing_width_;
  bearing_normal_[0] = {-std::sin(bearing_from_), std::cos(bearing_from_), 0};
  bearing_normal_[1] = {std::sin(to), -std::cos(to), 0};
}

Status MapView::set_sector(const View& view) {
  const auto [from, to] = view.bearing;
  if (!std::isfinite(from) || !std::isfinite(to))
    return invalid("view.bearing", "must be two finite numbers");
  double width = to - from;
  if (width < 2 * kPi) width -= 2 * kPi * std::floor(width / (2 * kPi));
  if (!(width > 0)) return invalid("view.bearing", "must not be empty: first equals second");
  set_bearing(from, width);
  if (dims_ == 3) {
    if (Status status = check_interval(view.elevation, "view.elevation"); !status) return status;
    if (view.elevation[0] >= kPi / 2 || view.elevation[1] <= -kPi / 2)
      return invalid("view.elevation", "must reach into -pi/2 .. pi/2");
    elevation_min_ = std::max(view.elevation[0], -kPi / 2);
    elevation_max_ = std::min(view.elevation[1], kPi / 2);
    has_floor_ = elevation_min_ > -kPi / 2;
    has_ceiling_ = elevation_max_ < kPi / 2;
    floor_normal_ = {-std::sin(elevation_min_), std::cos(elevation_min_)};
    ceiling_normal_ = {std::sin(elevation_max_), -std::cos(elevation_max_)};
  }
  return set_range(view);
}

Status MapView::set_frustum(const View& view) {
  if (Status status = check_opening(view.hfov, "view.hfov"); !status) return status;
  set_bearing(-view.hfov / 2, view.hfov);
  if (dims_ == 3) {
    if (Status status = check_opening(view.vfov, "view.vfov"); !status) return status;
    elevation_max_ = view.vfov / 2;
    elevation_min_ = -elevation_max_;
    has_floor_ = has_ceiling_ = true;
    floor_normal_ = {std::sin(elevation_max_), std::cos(elevation_max_)};
    ceiling_normal_ = {std::sin(elevation_max_), -std::cos(elevation_max_)};
  }
  return set_range(view);
}

Status MapView::set_polygon(const View& view) {
  std::vector<Eigen::Vector2d> points;
  for (const auto& point : view.points) points.emplace_back(point[0], point[1]);
  if (Status status = check_polygon(points, "view.points"); !status) return status;
  const Eigen::Matrix2d heading = level(rotation_).topLeftCorner<2, 2>();
  bounds_ = {kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (auto& point : points) {
    point = (heading * point + origin_.head<2>()).eval();
    bounds_ = {std::min(bounds_[0], point.x()), std::min(bounds_[1], point.y()),
               std::max(bounds_[2], point.x()), std::max(bounds_[3], point.y())};
  }
  polygon_.polygon = std::move(points);
  return Done{};
}

Eigen::Vector3d MapView::in_sensor(const Eigen::Vector3d& point_map) const {
  Eigen::Vector3d offset = point_map - origin_;
  if (dims_ == 2) offset.z() = 0;
  return rotation_.transpose() * offset;
}

/// The coordinate that elevation limits are measured against: a frustum's are planes, a sector's
/// are cones.
double MapView::along(const Eigen::Vector3d& p) const {
  return type_ == View::Type::kFrustum ? p.x() : p.head<2>().norm();
}

double MapView::Depth::least() const { return std::min({range, bearing, elevation}); }

MapView::Depth MapView::depth(const Eigen::Vector3d& p) const {
  Depth depth{kInfinity, kInfinity, kInfinity};
  const double distance = p.norm();
  depth.range = range_max_ - distance;
  if (range_min_ > 0) depth.range = std::min(depth.range, distance - range_min_);
  if (!all_bearings_) {
    const double a = bearing_normal_[0].dot(p), b = bearing_normal_[1].dot(p);
    // Up to half a turn both sides must hold, beyond it either is enough.
    depth.bearing = bearing_width_ <= kPi ? std::min(a, b) : std::max(a, b);
  }
  if (has_floor_ || has_ceiling_) {
    const Eigen::Vector2d flat(along(p), p.z());
    if (has_floor_) depth.elevation = floor_normal_.dot(flat);
    if (has_ceiling_) depth.elevation = std::min(depth.elevation, ceiling_normal_.dot(flat));
  }
  return depth;
}

bool MapView::contains(const Eigen::Vector3d& point_map) const {
  if (sees_everything()) return true;
  if (sees_nothing()) return false;
  if (type_ == View::Type::kPolygon) return polygon_.contains(point_map, 2);
  return depth(in_sensor(point_map)).least() >= 0;
}

std::array<double, 4> MapView::bounds() const { return bounds_; }

/// The box around the near and the far end of every ray of a grid of directions that holds the
/// edges of the view. Between its nodes the view reaches out further only to second order: by
/// 1/8 of the step squared on the sphere; twice that is added.
std::array<double, 4> MapView::reach() const {
  constexpr int kSteps = 16;
  const int rows = dims_ == 2 ? 0 : kSteps;
  const double bearing_step = bearing_width_ / kSteps;
  const double elevation_step = dims_ == 2 ? 0 : (elevation_max_ - elevation_min_) / kSteps;
  std::array<Eigen::Vector2d, kSteps + 1> bearing, elevation;
  for (int i = 0; i <= kSteps; ++i) {
    const double b = bearing_from_ + bearing_step * i, e = elevation_min_ + elevation_step * i;
    bearing[i] = {std::cos(b), std::sin(b)};
    elevation[i] = {std::cos(e), std::sin(e)};
  }
  std::array<double, 4> box{kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= rows; ++j) {
      Eigen::Vector3d ray(bearing[i].x(), bearing[i].y(), 0);
      if (dims_ == 3 && type_ == View::Type::kFrustum) {
        ray.z() = ray.x() * elevation[j].y() / elevation[j].x();
        ray.normalize();
      } else if (dims_ == 3) {
        ray *= elevation[j].x();
        ray.z() = elevation[j].y();
      }
      const Eigen::Vector2d across = rotation_.topRows<2>() * ray;
      for (const double range : {range_min_, range_max_}) {
        const Eigen::Vector2d end = origin_.head<2>() + across * range;
        box = {std::min(box[0], end.x()), std::min(box[1], end.y()), std::max(box[2], end.x()),
               std::max(box[3], end.y())};
      }
    }
  }
  const double slack =
      range_max_ * (bearing_step * bearing_step + elevation_step * elevation_step) / 4;
  return {box[0] - slack, box[1] - slack, box[2] + slack, box[3] + slack};
}

}  // namespace anchord
