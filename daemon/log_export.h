#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>

#include "api/replay_note.h"
#include "core/event.h"
#include "core/frame.h"
#include "core/result.h"
#include "core/time.h"

namespace anchord {

/// What an exported log consists of, in order.
using ExportedItem = std::variant<Frame, Event, ReplayNote>;

struct ExportReport {
  std::int64_t frames = 0, events = 0;
};

/// Gives all frames and events of the log in `directory` whose time lies from `from` to `to`, with
/// the notes that a replay needs to come to the same belief as the daemon at `to`: the
/// configurations in force, and, where the span does not begin with the log, the state before it. A
/// daemon may be running meanwhile. Stops at the first Error of `give`.
/// kUnknown: there is no log, or `from` lies before what it still holds.
Result<ExportReport> export_log(const std::string& directory, Utime from, Utime to,
                                const std::function<Status(const ExportedItem&)>& give);

}  // namespace anchord
