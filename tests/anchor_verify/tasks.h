#pragma once

#include "core/verification.h"

namespace anchord {

inline constexpr Utime kNow = 1'700'000'000'000'000;

/// To look for a red ball on the plaza with the sensor `camera`.
inline Task ball_task(std::int64_t id) {
  RegionOfInterest region;
  region.p = 0.95;
  region.center = {-10, -8, 0};
  region.covariance = {0.04, 0, 0, 0, 0.04, 0, 0, 0, 0};
  region.radius = 2.45;
  Task task;
  task.id = id;
  task.state = Task::State::kIssued;
  task.object = "ball-" + std::to_string(id);
  task.object_class = "ball";
  task.sensor = "camera";
  task.issued = kNow;
  task.deadline = kNow + 2'000'000;
  task.regions = {region};
  task.extent = {0.6, 0.6, 0.6};
  task.appearance = {{"color", SymbolReport{{{"red", 0.9}}}}};
  return task;
}

}  // namespace anchord
