#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/soak/watching.h"

namespace anchord::experiment {

/// The home and its sensors as lines of JSON, in the order of their times:
///
///     {"utime": T, "frame": {...}}                       of the robot's camera, four a second
///     {"utime": T, "frame": {...}, "lcm": "hex"}         of the hall's, one a second; frame_t
///     {"utime": T, "pose": "hex"}                        where the robot is, once a second;
///                                                        robot_pose_t
///     {"utime": T, "truth": [["cup", [x, y, z]], ...]}   what is really there, every ten seconds
///
/// Before them header() stands: {"query": "hex"}, the eight bytes with which a query_t begins.
///
/// The same seed and knowledge give the same lines, to the byte.
class HomeLines {
 public:
  HomeLines(const Knowledge& knowledge, std::uint64_t seed);

  static std::string header();

  /// The lines of the next quarter of a second.
  std::vector<std::string> next();

 private:
  std::string truth(Utime utime) const;

  const Knowledge& knowledge_;
  const Site site_;
  Home home_;
  Watch watch_;
  std::int64_t quarter_ = 0;
};

}  // namespace anchord::experiment
