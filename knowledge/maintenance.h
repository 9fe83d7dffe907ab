#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/frame.h"

namespace anchord {

/// How a sensor serves verification tasks. What it can see is its `view`.
struct Verification {
  Pose mount;              ///< of the sensor in the robot's base frame
  bool moves_base = true;  ///< false: it looks from where the robot is, no way is driven for it
  double cost = 0;         ///< of one measurement, added to the cost of the way (unit of (3.8))
  double dwell = 0;        ///< s that it looks at the end of the way
  /// Per class: measurement covariance, sensor frame, row-major, d*d numbers.
  std::vector<std::vector<double>> noise;
};

/// How the maintenance coordinator decides what to look at (thesis section 3.5).
struct Maintenance {
  enum class Planner {
    kGreedy,    ///< the best next look, thesis (3.10)
    kLookahead  ///< the first of the best sequence of looks
  };
  /// What a planner's action asks to be looked at first (thesis table 3.1).
  enum class Verify { kObject, kNothing };
  struct ActionRule {
    std::string action;
    Verify verify = Verify::kObject;
  };

  Planner planner = Planner::kGreedy;
  double threshold = 1;    ///< IG_thr of (3.7), nat
  double omega = 0.75;     ///< weight of the cost in (3.9)
  double gain_norm = 5;    ///< IG_norm of (3.9), nat
  double cost_scale = 0;   ///< C_scale of (3.8), m; once read: above 0
  double speed = 0.5;      ///< of the robot, m/s
  double step = 1;         ///< of the forward simulation, s
  double clearance = 0.3;  ///< that a way keeps from the ends of walls, m
  int horizon = 4;         ///< viewpoints that kLookahead looks ahead
  double timeout = 60;     ///< s that a task lives
  bool enabled = false;    ///< false: only triggers are served
  std::vector<ActionRule> actions{
      {"grab", Verify::kObject}, {"navigate", Verify::kObject}, {"release", Verify::kNothing}};
};

}  // namespace anchord
