#include "tools/frame_source.h"

#include <cerrno>
#include <cstring>
#include <iostream>

#include "api/event_json.h"
#include "api/frame_json.h"
#include "api/json_text.h"

namespace anchord {

namespace {

Result<Input> parse_input(const std::string& line, int dims) {
  const auto json = parse_json(line);
  if (!json) return json.error();
  if (json->is_object() && json->contains("event")) {
    auto event = event_from_json(*json, dims);
    if (!event) return event.error();
    return Input(*std::move(event));
  }
  auto frame = frame_from_json(*json);
  if (!frame) return frame.error();
  return Input(*std::move(frame));
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
  if (log_) return log_->next_input();
  std::string line;
  while (std::getline(*stream_, line)) {
    ++line_;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto input = parse_input(line, dims_);
    if (!input) return input.error();
    return std::optional(*std::move(input));
  }
  return std::optional<Input>();
}

std::string FrameSource::position() const {
  return log_ ? path_ + ": event " + std::to_string(log_->events())
              : path_ + ":" + std::to_string(line_);
}

}  // namespace anchord
