#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "core/event.h"
#include "core/result.h"

namespace anchord {

/// An event from JSON, the body of a request or a line of a frames file:
///
///     {"utime": T, "event": "grasped", "object": "cup-1", "robot": "amigo"}
///     {"utime": T, "event": "placed", "object": "cup-1", "place": "kitchen_table"}
///     {"utime": T, "event": "moved", "object": "cup-1", "position": [..], "covariance": [..]}
///     {"utime": T, "event": "removed", "object": "cup-1"}
///     {"utime": T, "event": "carried", "robot": "amigo", "position": [..]}
///     {"utime": T, "event": "missing", "object": "cup-1", "sensor": "kinect", "regions": [..]}
///     {"utime": T, "event": "named", "object": "cup-1", "name": "my mug"}
///     {"utime": T, "event": "joined", "object": "cup-1", "other": "cup-7"}
///     {"utime": T, "event": "dropped", "object": "cup-9"}
///     {"utime": T, "event": "undone", "number": 12}
///
/// A position has 3 numbers and its covariance 9; in a world of `dims` 2 also 2 and 4. A region is
/// {"center": [3], "covariance": [9], "radius": r, "p": p} or
/// {"polygon": [[x, y], ..], "z": [low, high], "p": p}. Refused, with the field: what parse_frame()
/// refuses, kinds of events that there are not, a `named` without `name` ("" takes the name back),
/// an `undone` without `number`. Unknown members are ignored.
Result<Event> parse_event(std::string_view text, int dims = 3);
Result<Event> event_from_json(const nlohmann::json& json, int dims = 3);

/// What event_from_json() makes the same event of.
nlohmann::json to_json(const Event& event);

nlohmann::json to_json(const RegionOfInterest& region);

/// `grasped`, `placed`, ...
const char* to_string(Event::Kind kind);

}  // namespace anchord
