#include "tools/frame_source.h"

#include <cerrno>
#include <cstring>
#include <iostream>

#include "api/event_json.h"
#include "api/frame_json.h"
#include "api/json_text.h"

namespace anchord {

namespace {

using Item = FrameSource::Item;

Result<Item> parse_note(const nlohmann::json& json, int dims) {
  auto note = note_from_json(json, dims);
  if (!note) return note.error();
  return Item(*std::move(note));
}

Result<Item> parse_item(const std::string& line, int dims) {
  const auto json = parse_json(line);
  if (!json) return json.error();
  if (is_note(*json)) return parse_note(*json, dims);
  if (json->is_object() && json->contains("event")) {
    auto event = event_from_json(*json, dims);
    if (!event) return event.error();
    return Item(*std::move(event));
  }
  auto frame = frame_from_json(*json);
  if (!frame) return frame.error();
  return Item(*std::move(frame));
}

}  // namespace

Result<std::unique_ptr<FrameSource>> FrameSource::open(const std::string& path, int dims) {
  auto source = std::make_unique<FrameSource>();
  source->dims_ = dims;
  source->path_ = path == "-" ? "standard input" : path;
  source->stream_ = &std::cin;
  if (path != "-") {
    source->file_.open(path, std::ios::binary);
    if (!source->file_)
      return Error{ErrorCode::kIo, "", path + " cannot be read: " + std::strerror(errno)};
    source->stream_ = &source->file_;
  }
  if (path.ends_with(".lcm") || path.ends_with(".lcmlog")) source->log_.emplace(*source->stream_);
  return source;
}

Result<std::optional<Input>> FrameSource::next() {
  for (;;) {
    auto item = next_item();
    if (!item) return item.error();
    if (!*item) return std::optional<Input>();
    if (auto* frame = std::get_if<Frame>(&**item)) return std::optional<Input>(std::move(*frame));
    if (auto* event = std::get_if<Event>(&**item)) return std::optional<Input>(std::move(*event));
  }
}

Result<std::optional<Item>> FrameSource::next_item() {
  if (log_) {
    auto item = log_->next_item();
    if (!item) return item.error();
    if (!*item) return std::optional<Item>();
    if (auto* frame = std::get_if<Frame>(&**item)) return std::optional<Item>(std::move(*frame));
    if (auto* event = std::get_if<Event>(&**item)) return std::optional<Item>(std::move(*event));
    const auto json = parse_json(std::get<std::string>(**item));
    if (!json) return json.error();
    auto note = parse_note(*json, dims_);
    if (!note) return note.error();
    return std::optional(*std::move(note));
  }
  std::string line;
  while (std::getline(*stream_, line)) {
    ++line_;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto item = parse_item(line, dims_);
    if (!item) return item.error();
    return std::optional(*std::move(item));
  }
  return std::optional<Item>();
}

std::string FrameSource::position() const {
  return log_ ? path_ + ": event " + std::to_string(log_->events())
              : path_ + ":" + std::to_string(line_);
}

}  // namespace anchord
