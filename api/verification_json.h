#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "core/result.h"
#include "core/verification.h"

namespace anchord {

/// A trigger, the body of POST /v1/verifications. One of these names what to look at:
///
///     {"object": "cup-1"}
///     {"description": "class=cup&color=blue"}   as in a question; who most probably is meant
///     {"class": "cup", "color": "blue"}         the same
///
/// and beside it, all optional: "action" (what the planner is about to do, see the configuration's
/// `maintenance.actions`), "robot", "sensor", "timeout" (s), "alone" (true: do not join a task that
/// waits for this object), "tag" (a number of the planner's own). Refused, with the field: other
/// members of a wrong type, none or several of the ways to name an object.
Result<Trigger> parse_trigger(std::string_view text);

/// A result, the body of POST /v1/verifications/{id}/result, for the task of that number:
///
///     {"outcome": "found", "frame": {a frame with one detection}}
///     {"outcome": "missing", "utime": T, "sensor": "kinect"}
///     {"outcome": "occluded"}
Result<VerificationResult> parse_result(std::string_view text, std::int64_t task);

/// A task, as GET /v1/verifications/{id} answers it.
nlohmann::json to_json(const Task& task);

/// `queued`, `issued`, `found`, ...
const char* to_string(Task::State state);

}  // namespace anchord
