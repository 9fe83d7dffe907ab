#include "api/replay_note.h"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <exception>

#include "api/event_json.h"
#include "api/frame_json.h"

namespace anchord {
namespace {

namespace iterators = boost::archive::iterators;
using nlohmann::json;

/// Without padding.
std::string base64(const std::vector<std::uint8_t>& bytes) {
  using Text = iterators::base64_from_binary<
      iterators::transform_width<std::vector<std::uint8_t>::const_iterator, 6, 8>>;
  return {Text(bytes.begin()), Text(bytes.end())};
}

Result<std::vector<std::uint8_t>> from_base64(const std::string& text) {
  using Bytes =
      iterators::transform_width<iterators::binary_from_base64<std::string::const_iterator>, 8, 6>;
  const std::size_t size = text.size() * 6 / 8;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(size);
  try {
    std::string padded = text + std::string((4 - text.size() % 4) % 4, 'A');
    Bytes next(padded.cbegin());
    for (std::size_t i = 0; i < size; ++i, ++next) bytes.push_back(*next);
  } catch (const std::exception&) {  // a character that is none of the 64
    return invalid("state.checkpoint", "must be base64");
  }
  return bytes;
}

Result<Accepted> accepted_from_json(const json& item, int dims) {
  if (item.is_object() && item.contains("event") && item["event"].is_object()) {
    auto event = event_from_json(item["event"], dims);
    if (!event) return event.error();
    return Accepted{*std::move(event)};
  }
  if (!item.is_object() || !item.contains("frame"))
    return invalid("state.recent", "must be frames and events");
  auto frame = frame_from_json(item["frame"]);
  if (!frame) return frame.error();
  Accepted accepted{*std::move(frame)};
  if (item.contains("work") && item["work"].is_number_unsigned())
    accepted.work = item["work"].get<std::uint64_t>();
  return accepted;
}

Result<ReplayNote::State> state_from_json(const json& state, int dims) {
  if (!state.is_object() || !state.contains("checkpoint") || !state["checkpoint"].is_string())
    return invalid("state.checkpoint", "must be base64");
  auto bytes = from_base64(state["checkpoint"].get_ref<const std::string&>());
  if (!bytes) return bytes.error();
  ReplayNote::State out{*std::move(bytes), {}};
  if (!state.contains("recent")) return out;
  if (!state["recent"].is_array()) return invalid("state.recent", "must be an array");
  for (const json& item : state["recent"]) {
    auto accepted = accepted_from_json(item, dims);
    if (!accepted) return accepted.error();
    out.recent.push_back(*std::move(accepted));
  }
  return out;
}

}  // namespace

bool is_note(const json& note) {
  return note.is_object() &&
         (note.contains("configuration") || note.contains("state") || note.contains("next"));
}

Result<ReplayNote> note_from_json(const json& note, int dims) {
  ReplayNote out;
  if (!is_note(note)) return invalid("", "must be a configuration, a state or what comes next");
  if (note.contains("configuration")) {
    if (!note["configuration"].is_object()) return invalid("configuration", "must be an object");
    out.configuration = note["configuration"].dump();
  }
  if (note.contains("state")) {
    auto state = state_from_json(note["state"], dims);
    if (!state) return state.error();
    out.state = *std::move(state);
  }
  if (note.contains("next")) {
    const json& next = note["next"];
    if (!next.is_object()) return invalid("next", "must be an object");
    for (const char* name : {"number", "work"}) {
      if (!next.contains(name)) continue;
      if (!next[name].is_number_integer() || next[name].get<std::int64_t>() < 0)
        return invalid(std::string("next.") + name, "must be a whole number of at least 0");
    }
    if (next.contains("number")) out.number = next["number"].get<std::int64_t>();
    if (next.contains("work")) out.work = next["work"].get<std::uint64_t>();
  }
  return out;
}

json to_json(const ReplayNote& note) {
  json out = json::object();
  if (!note.configuration.empty()) out["configuration"] = json::parse(note.configuration);
  if (note.state) {
    json recent = json::array();
    for (const Accepted& one : note.state->recent) {
      json item;
      if (const auto* frame = std::get_if<Frame>(&one.what))
        item["frame"] = to_json(*frame);
      else
        item["event"] = to_json(std::get<Event>(one.what));
      if (one.work) item["work"] = *one.work;
      recent.push_back(std::move(item));
    }
    out["state"] = {{"checkpoint", base64(note.state->checkpoint)}, {"recent", recent}};
  }
  if (note.number) out["next"]["number"] = *note.number;
  if (note.work) out["next"]["work"] = *note.work;
  return out;
}

}  // namespace anchord
