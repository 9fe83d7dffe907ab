#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/event.h"
#include "core/frame.h"
#include "core/time.h"

namespace anchord {

/// A planner's demand for a look.
struct Trigger {
  std::string object;       ///< an anchor's id or alias; or empty, and
  std::string description;  ///< a description as in a query: `class=cup&color=blue`
  std::string action;    ///< instead of asking outright: what the planner is about to do (`grab`)
  std::string robot;     ///< whose sensors shall look; empty: any
  std::string sensor;    ///< which sensor; empty: the best
  double timeout_s = 0;  ///< expires after it; 0: the configured time
  bool alone = false;    ///< true: a task of its own, even if one for this object waits
  std::int64_t tag = 0;  ///< the planner's own number, given back in the task; 0: none
  bool operator==(const Trigger&) const = default;
};

/// A verification task and what has become of it.
struct Task {
  enum class State {
    kQueued = 0,  ///< waits for its turn
    kIssued = 1,  ///< sent out; somebody shall look
    kFound = 2,   ///< the last five are ends
    kMissing = 3,
    kOccluded = 4,
    kExpired = 5,
    kCancelled = 6
  };
  std::int64_t id = 0;  ///< counts up from 1
  State state = State::kQueued;
  bool triggered = false;          ///< by a planner; else the coordinator's own choice
  std::vector<std::int64_t> tags;  ///< of the triggers that were joined in it
  std::string action;              ///< that was announced, or empty
  std::string object;              ///< the anchor's id
  std::string object_class;
  std::string robot, sensor;
  std::string wanted_sensor;  ///< that the trigger asked for, or empty
  Utime created = 0;          ///< world time, as `deadline`, `issued` and `ended`
  Utime issued = 0;           ///< 0: not yet
  Utime ended = 0;            ///< 0: not yet
  Utime deadline = 0;
  std::optional<Pose> viewpoint;            ///< where the robot's base shall stand, map frame
  std::vector<RegionOfInterest> regions;    ///< 95 % of the predicted density
  std::vector<AttributeReport> appearance;  ///< what is believed of its looks
  std::array<double, 3> extent{};           ///< of its class, m; zeros: unknown
  double gain_nat = 0;                      ///< expected information gain of the whole action
  double cost = 0;
  double utility = 0;
  std::string reason;  ///< why it was chosen, or why it ended, in words
  bool ended_already() const { return state >= State::kFound; }
  bool operator==(const Task&) const = default;
};

/// Most triggers that may be joined in one task.
inline constexpr std::size_t kMaxTags = 256;

/// What a verification module answers.
struct VerificationResult {
  enum class Outcome { kFound = 0, kMissing = 1, kOccluded = 2 };
  std::int64_t task = 0;
  Outcome outcome = Outcome::kFound;
  Utime utime = 0;             ///< of the look; kFound: the frame's
  std::string robot, sensor;   ///< that looked, kMissing
  std::optional<Frame> frame;  ///< kFound: with one detection, which names the task's object
  bool operator==(const VerificationResult&) const = default;
};

/// Where a robot's base is.
struct RobotPose {
  Utime utime = 0;
  std::string robot;
  Pose pose;  ///< of the base, map frame
  bool operator==(const RobotPose&) const = default;
};

}  // namespace anchord
