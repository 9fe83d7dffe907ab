#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/verification.h"
#include "geometry/view.h"
#include "knowledge/knowledge.h"
#include "maintenance/way.h"

namespace anchord {

/// Where a robot's base stands: on the floor, upright.
struct BasePose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< map frame, m
  double yaw = 0;
  double z = 0;  ///< of the base, map frame, m

  static BasePose of(const Pose& pose);
  Pose pose() const;
};

/// A sensor that may be asked for a look, prepared for computing.
struct Eye {
  int sensor = 0;  ///< index into Knowledge::sensors
  bool moves_base = true;
  double cost = 0, dwell = 0;
  MapView view;                ///< in the sensor frame
  double reach;                ///< m from the sensor, beyond which it sees nothing; may be infinite
  std::vector<double> ranges;  ///< m, at which to stand from an object, the best first
  double bearing = 0;          ///< middle of what it sees, sensor frame
  Eigen::Vector3d mount = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< base from sensor
  double yaw = 0;                                          ///< of the sensor in the base
  std::vector<Eigen::Matrix3d> noise;                      ///< per class, base frame
};

/// Where an eye is while its base stands somewhere: computed once for all that it may see.
struct Stance {
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();  ///< map frame, m
  double c = 1, s = 0;                               ///< cosine and sine of the base's yaw
};

/// The knowledge, prepared for deciding what to look at: sensors, walls and ways. Immutable.
struct Site {
  explicit Site(const Knowledge& knowledge);

  const int dims;
  const Maintenance settings;
  const Eigen::Vector3d bounds_min, bounds_max;
  std::vector<Eye> eyes;  ///< the sensors with `verification`, in configuration order
  std::vector<std::string> sensor_names;  ///< of the eyes
  WayMap ways;

  Stance stance(const Eye& eye, const BasePose& base) const;
  /// Whether an eye sees a point from there: in its view, and no wall before it.
  bool sees(const Eye& eye, const BasePose& base, const Eigen::Vector3d& point_map) const {
    return sees(eye, stance(eye, base), point_map);
  }
  bool sees(const Eye& eye, const Stance& stance, const Eigen::Vector3d& point_map) const;
};

}  // namespace anchord
