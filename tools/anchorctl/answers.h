#pragma once

#include <optional>
#include <string>

#include "tools/anchorctl/fields.h"
#include "tools/anchorctl/table.h"

namespace anchord {

/// The daemon's answers as text for people; every function takes the JSON of one call and gives
/// whole lines.

/// Who may be meant and where it is, then where undetected ones may be.
std::string where_text(const Json& answer, const Style& style);

/// `GET /v1/objects` as a table, or `GET /v1/objects/{id}` with its models and alternatives.
std::string objects_text(const Json& answer, const Style& style);

/// "2 (0.79)  1 (0.20)": how many, most probable first.
std::string count_text(const Json& answer, const Style& style);

/// The most probable world, and in what each of the others differs from it.
std::string hypotheses_text(const Json& answer, const Style& style);

/// `GET /v1/history` as a table, oldest first.
std::string history_text(const Json& answer, const Style& style);

/// `GET /v1/verifications` as a table, newest last: those that wait or are being done, and if `all`
/// also those that have ended. `newest` is the time of the newest frame.
std::string verify_text(const Json& answer, std::optional<Utime> newest, bool all,
                        const Style& style);

/// One line about a task, or about an action that needs none.
std::string task_text(const Json& task);

/// One line about what `event` has changed, with its number from the daemon's `answer`, and how it
/// is undone.
std::string event_text(const Json& event, const Json& answer);

/// One line for each part of the daemon. `server` is where it was asked.
std::string status_text(const Json& answer, const std::string& server, const Style& style);

}  // namespace anchord
