#pragma once

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "core/frame.h"
#include "core/result.h"

namespace anchord {

/// A frame from JSON, one line of a frames file or the body of a request:
///
///     {"utime": 1700000000000000, "sensor": "kinect", "robot": "amigo",
///      "pose": {"position": [0,0,1.2], "orientation": [1,0,0,0], "covariance": [36 numbers]},
///      "view": {"type": "world"},
///      "detections": [{"position": [1,0.2,0.9], "covariance": [9 numbers], "score": 0.9,
///                      "yaw": 0.1, "object": "cup-1",
///                      "attributes": {"class": {"cup": 0.8},
///                                     "size": {"mean": 0.12, "variance": 0.0004}}}]}
///
/// Needed: utime, sensor, detections; of a pose position and orientation; of a detection either
/// position or polar {range, bearing, elevation, variance}. A pose without covariance is exact, an
/// elevation left out of polar is 0, a
/// sector without elevation sees all of it, an attribute with a member `mean` or `variance` is a
/// scalar. Unknown members are ignored.
///
/// Refused, with the field (`detections[3].covariance`): what parse_json() refuses, wrong types,
/// wrong counts of numbers, integers out of range, unknown kinds of view, more than the limits of
/// lcmtypes/names.h and kMaxDetections. What the numbers mean is checked where they are used.
/// Attributes and symbols come out in the order of their names.
Result<Frame> parse_frame(std::string_view text);

/// As parse_frame(), from JSON that is parsed already.
Result<Frame> frame_from_json(const nlohmann::json& json);

/// One frame or an array of frames; errors in an array's frame start with its index: `[2].utime`.
Result<std::vector<Frame>> parse_frames(std::string_view text);

/// What frame_from_json() makes the same frame of, to the last bit, if its attributes and symbols
/// are in the order of their names and its numbers finite.
nlohmann::json to_json(const Frame& frame);

}  // namespace anchord
