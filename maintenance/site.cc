#include "maintenance/site.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/rotation.h"

namespace anchord {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double heading(const Eigen::Matrix3d& rotation) {
  const Eigen::Matrix3d flat = level(rotation);
  return std::atan2(flat(1, 0), flat(0, 0));
}

/// Where along its ranges a sensor is best placed: the middle, then nearer and farther.
void set_ranges(const View& view, Eye& eye) {
  double low = 0, high = 0;
  if (view.type == View::Type::kWorld) {
    eye.reach = kInfinity;
  } else if (view.type == View::Type::kPolygon) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const auto& corner : view.points) {
      middle += Eigen::Vector2d(corner[0], corner[1]) / static_cast<double>(view.points.size());
      eye.reach = std::max(eye.reach, std::hypot(corner[0], corner[1]));
    }
    eye.bearing = std::atan2(middle.y(), middle.x());
    low = high = middle.norm();
  } else {
    low = view.range[0];
    high = view.range[1];
    eye.reach = high;
    if (view.type == View::Type::kSector) {
      double width = view.bearing[1] - view.bearing[0];
      if (width <= 0) width += 2 * M_PI;
      eye.bearing = std::remainder(view.bearing[0] + width / 2, 2 * M_PI);
      if (width >= 2 * M_PI - 1e-9) eye.bearing = 0;  // all round: no side is its middle
    }
  }
  for (const double share : {0.5, 0.65, 0.35, 0.8, 0.2, 0.9})
    eye.ranges.push_back(low + share * (high - low));
}

Eye eye_of(const Sensor& sensor, int index, int dims) {
  const Verification& use = *sensor.verification;
  Eye eye{index,
          use.moves_base,
          use.cost,
          use.dwell,
          MapView::place(*sensor.view, std::nullopt, dims).value(),
          0,
          {},
          0,
          {},
          {},
          0,
          {}};
  set_ranges(*sensor.view, eye);
  eye.mount = {use.mount.position[0], use.mount.position[1], use.mount.position[2]};
  eye.rotation = rotation_of(use.mount);
  eye.yaw = heading(eye.rotation);
  if (dims == 2) {
    eye.mount.z() = 0;
    eye.rotation = level(eye.rotation);
  }
  for (const std::vector<double>& numbers : use.noise) {
    Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
    noise.topLeftCorner(dims, dims) =
        Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(numbers.data(), dims,
                                                                         dims);
    eye.noise.push_back(eye.rotation * noise * eye.rotation.transpose());
  }
  return eye;
}

}  // namespace

BasePose BasePose::of(const Pose& pose) {
  return {{pose.position[0], pose.position[1]}, heading(rotation_of(pose)), pose.position[2]};
}

Pose BasePose::pose() const {
  Pose out;
  out.position = {position.x(), position.y(), z};
  out.orientation = {std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)};
  return out;
}

Site::Site(const Knowledge& knowledge)
    : dims(knowledge.dims),
      settings(knowledge.maintenance),
      bounds_min(knowledge.bounds_min),
      bounds_max(knowledge.bounds_max),
      ways(knowledge.walls, settings.clearance, bounds_min.head<2>(), bounds_max.head<2>()) {
  for (std::size_t i = 0; i < knowledge.sensors.size(); ++i) {
    if (!knowledge.sensors[i].verification) continue;
    eyes.push_back(eye_of(knowledge.sensors[i], static_cast<int>(i), dims));
    sensor_names.push_back(knowledge.sensors[i].name);
  }
}

Stance Site::stance(const Eye& eye, const BasePose& base) const {
  const double c = std::cos(base.yaw), s = std::sin(base.yaw);
  return {{base.position.x() + c * eye.mount.x() - s * eye.mount.y(),
           base.position.y() + s * eye.mount.x() + c * eye.mount.y(),
           dims == 3 ? base.z + eye.mount.z() : 0},
          c,
          s};
}

bool Site::sees(const Eye& eye, const Stance& stance, const Eigen::Vector3d& point_map) const {
  const Eigen::Vector3d d = point_map - stance.sensor;
  if (!(d.head<2>().squaredNorm() <= eye.reach * eye.reach)) return false;
  const double c = stance.c, s = stance.s;
  const Eigen::Vector3d in_base(c * d.x() + s * d.y(), c * d.y() - s * d.x(),
                                dims == 3 ? d.z() : 0);
  if (!eye.view.contains(eye.rotation.transpose() * in_base)) return false;
  return !ways.walls().hide(stance.sensor, point_map);
}

}  // namespace anchord
