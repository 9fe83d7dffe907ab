#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/frame.h"
#include "core/result.h"

namespace anchord {

/// A frame as it came over LCM.
struct FrameMessage {
  Frame frame;
  std::int64_t seq =
      0;  ///< counts up by 1 for each frame of its publisher, from 1; 0: not numbered
};

/// A question as it came over LCM.
struct Query {
  std::int64_t id = 0;  ///< copied into the answer
  std::string target;   ///< the target of a GET
  bool operator==(const Query&) const = default;
};

/// The frame in an encoded frame_t. The bytes are untrusted: see check_frame() for what is refused;
/// repeated attributes of a detection and repeated symbols of an attribute are too. Numbers are
/// taken as they are: what they mean is checked where they are used.
///
/// What the message's own flags leave unused (the pose without has_pose, the bearing of a frustum)
/// is not looked at and has its default in the Frame. A position has 2 numbers if its covariance
/// has 4, and 3 if it has 9 or none: a 2-D world ignores the third.
Result<FrameMessage> decode_frame(std::span<const std::uint8_t> bytes);

/// The query in an encoded query_t; see check_query() for what is refused.
Result<Query> decode_query(std::span<const std::uint8_t> bytes);

}  // namespace anchord
