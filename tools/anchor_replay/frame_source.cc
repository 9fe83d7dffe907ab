#include "tools/anchor_replay/frame_source.h"

#include <cerrno>
#include <cstring>
#include <iostream>

#include "api/frame_json.h"

namespace anchord {

Result<std::unique_ptr<FrameSource>> FrameSource::open(const std::string& path) {
  auto source = std::make_unique<FrameSource>();
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

Result<std::optional<Frame>> FrameSource::next() {
  if (log_) {
    auto message = log_->next_frame();
    if (!message) return message.error();
    if (!*message) return std::optional<Frame>();
    return std::optional<Frame>(std::move((**message).frame));
  }
  std::string line;
  while (std::getline(*stream_, line)) {
    ++line_;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto frame = parse_frame(line);
    if (!frame) return frame.error();
    return std::optional<Frame>(std::move(*frame));
  }
  return std::optional<Frame>();
}

std::string FrameSource::position() const {
  return log_ ? path_ + ": event " + std::to_string(log_->events())
              : path_ + ":" + std::to_string(line_);
}

}  // namespace anchord
