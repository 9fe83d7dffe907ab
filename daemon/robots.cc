#include "daemon/robots.h"

#include "core/time.h"
#include "geometry/conversion.h"

namespace anchord {

Status Robots::set(const RobotPose& pose) {
  if (pose.utime < kEarliestUtime || pose.utime > kLatestUtime)
    return invalid("utime", "must lie in the years 2000 to 2100, in microseconds since 1970");
  if (Status good = check_pose(pose.pose); !good) return good;
  std::lock_guard lock(mutex_);
  forget();
  const auto known = poses_.find(pose.robot);
  if (known == poses_.end() && poses_.size() >= kMost)
    return Error{ErrorCode::kTooLarge, "robot", "is one more than the 64 robots that are kept"};
  if (known != poses_.end() && pose.utime < known->second.pose.utime)
    return Error{ErrorCode::kConflict, "utime", "is before this robot's last pose"};
  poses_[pose.robot] = {pose, std::chrono::steady_clock::now()};
  return Done{};
}

/// With mutex_ held.
void Robots::forget() {
  const auto oldest = std::chrono::steady_clock::now() - kHolds;
  std::erase_if(poses_, [&](const auto& entry) { return entry.second.at < oldest; });
}

std::optional<RobotPose> Robots::find(const std::string& robot) {
  std::lock_guard lock(mutex_);
  forget();
  const auto known = poses_.find(robot);
  return known == poses_.end() ? std::nullopt : std::optional(known->second.pose);
}

std::vector<RobotPose> Robots::all() {
  std::lock_guard lock(mutex_);
  forget();
  std::vector<RobotPose> out;
  for (const auto& [robot, told] : poses_) out.push_back(told.pose);
  return out;
}

}  // namespace anchord
