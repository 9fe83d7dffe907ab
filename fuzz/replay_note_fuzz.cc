#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "api/json_text.h"
#include "api/replay_note.h"
#include "fuzz/require.h"

/// A line of an exported log is a note that comes back the same through JSON, or is refused in
/// words that fit into JSON.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto json = anchord::parse_json({reinterpret_cast<const char*>(data), size});
  if (!json) return 0;
  const auto note = anchord::note_from_json(*json, 3);
  if (!note) {
    (void)nlohmann::json(note.error().text()).dump();  // throws if it is no UTF-8
    return 0;
  }
  const auto written = anchord::to_json(*note);
  if (written.empty()) return 0;  // it says nothing
  const auto again = anchord::note_from_json(written, 3);
  require(again.ok() && again->configuration == note->configuration);
  require(again->number == note->number && again->work == note->work);
  require(again->state.has_value() == note->state.has_value());
  require(!note->state || again->state->checkpoint == note->state->checkpoint);
  return 0;
}
