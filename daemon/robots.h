#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/verification.h"

namespace anchord {

/// Where each robot was last. One that has told nothing for a while may be anywhere, or gone: it is
/// forgotten. Safe from any thread.
class Robots {
 public:
  /// Robots that are kept; one more is refused.
  static constexpr std::size_t kMost = 64;

  /// How long a pose holds.
  static constexpr std::chrono::seconds kHolds{10};

  /// Refuses a pose that is none (see check_pose()), one of no time, one older than the last.
  Status set(const RobotPose& pose);
  std::optional<RobotPose> find(const std::string& robot);
  std::vector<RobotPose> all();

 private:
  struct Told {
    RobotPose pose;
    std::chrono::steady_clock::time_point at;
  };
  void forget();

  std::mutex mutex_;
  std::map<std::string, Told> poses_;
};

}  // namespace anchord
