#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/verification.h"

namespace anchord {

/// Where each robot was last. Safe from any thread.
class Robots {
 public:
  /// Robots that are kept; one more is refused.
  static constexpr std::size_t kMost = 64;

  /// Refuses a pose that is none (see check_pose()), one of no time, one older than the last.
  Status set(const RobotPose& pose);
  std::optional<RobotPose> find(const std::string& robot) const;
  std::vector<RobotPose> all() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, RobotPose> poses_;
};

}  // namespace anchord
