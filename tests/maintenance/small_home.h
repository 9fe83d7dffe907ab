#pragma once

#include <string>
#include <vector>

#include "anchoring/reading.h"
#include "anchoring/world.h"
#include "knowledge/knowledge.h"
#include "maintenance/planner.h"

namespace anchord {

/// A flat room of 10 x 10 m with one class `cup` and the sensor `eye`, which sees all round from
/// 0.4 to 2 m with a noise of 0.01 m^2 per axis, as in the thesis' simulation (section 3.7.1).
struct RoomOptions {
  double p_d = 0.999;                          ///< below 1: a belief is never empty
  std::string maintenance;                     ///< members of "maintenance", as JSON text
  std::string walls = "[]";                    ///< of the world, as JSON text
  std::string more_sensors;                    ///< further members of "sensors"
  std::string verification = R"("dwell": 0)";  ///< members of the eye's
  std::string models = R"([{"kind": "constant_position", "position_psd": 0.001}])";
};
Knowledge room(const RoomOptions& options = {});

/// A cup at a place that has variance `variance` per axis.
Subject cup(const std::string& id, double x, double y, double variance, const Knowledge& knowledge,
            double psd = 0.001, double p = 1);

/// The subject with its detection probability set for every sensor, 1 included.
Subject with_q(Subject subject, double q);

/// Robot `pip` there, facing along x.
RobotPose robot_at(double x, double y, const std::string& name = "pip");

/// Time 0 of these tests.
inline constexpr Utime kStart = 1'700'000'000'000'000;

/// A frame of the eye, in the map frame, seeing the world: detections with a variance.
Frame cups_at(const std::vector<std::array<double, 2>>& positions, Utime utime,
              double variance = 0.01);

/// What is believed some seconds after kStart of the one object there is.
ObjectBelief only_object(const World& world, double seconds);

/// A room with one cup, seen at (5, 5) at kStart, that may get lost: its models are `tracked`, as
/// JSON text, and a `somewhere` entered at 0.01 / s.
World with_a_cup_that_gets_lost(const std::string& tracked);

}  // namespace anchord
