#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "anchoring/world.h"
#include "core/result.h"

namespace anchord {

/// What an exported log says beside frames and events, so that folding it again comes to the same
/// belief: a line of JSON among the frames' lines, or a message on kReplayChannel of an LCM log.
///
///     {"configuration": {...}}             from here on this one is in force
///     {"state": {"checkpoint": "base64", "recent": [{"frame": {...}, "work": N}, {"event":
///     {...}}]}}
///     {"next": {"number": N, "work": N}}   of the frame or event that follows
struct ReplayNote {
  /// Where a span begins that is not the log's beginning: a checkpoint (anchoring/checkpoint.h),
  /// and what WorldState::recent names.
  struct State {
    std::vector<std::uint8_t> checkpoint;
    std::vector<Accepted> recent;
  };
  std::string configuration;  ///< Knowledge::text; empty: none
  std::optional<State> state;
  std::optional<std::int64_t> number;  ///< in the log, if it is not one more than that before
  std::optional<std::uint64_t> work;   ///< bound on the work of folding it
};

/// Whether a line is a note.
bool is_note(const nlohmann::json& json);
/// Refused, with the field: what is none, or cannot be read. `dims`: the world's, for events.
Result<ReplayNote> note_from_json(const nlohmann::json& json, int dims);
nlohmann::json to_json(const ReplayNote& note);

}  // namespace anchord
