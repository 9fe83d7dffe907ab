#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "anchoring/reading.h"
#include "api/belief_json.h"
#include "core/frame.h"

namespace anchord {

/// A frame of the log, and its number there.
struct NumberedFrame {
  std::int64_t number = 0;
  Frame frame;
};
/// The frames of one time, of all sensors; those that are given up or cannot be read are missing.
using FramesAt = std::function<std::vector<NumberedFrame>(Utime)>;

/// By whom an object was last seen, where, in which frame: {"utime", "robot", "sensor", "frame" its
/// number in the log, "detection" its index there, "position" as measured, map frame}. Of several
/// frames of that time it is the one whose detection lies nearest to where the object is. Without a
/// frame only the utime; null if it was never given a detection.
Json sighting_json(const ObjectBelief& object, const FramesAt& frames_at,
                   const Background& background);

}  // namespace anchord
