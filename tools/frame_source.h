#pragma once

#include <fstream>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "api/lcm_log.h"
#include "api/replay_note.h"
#include "core/event.h"
#include "core/frame.h"
#include "core/result.h"

namespace anchord {

/// What stood next in a file.
using Input = std::variant<Frame, Event>;

/// Frames and events from a file: JSON lines (one with a member `event` is an event), or an LCM log
/// if its name ends in `.lcm` or `.lcmlog`; "-" is standard input, JSON lines. `dims`: the world's,
/// for positions of events.
class FrameSource {
 public:
  static Result<std::unique_ptr<FrameSource>> open(const std::string& path, int dims);

  /// The next frame or event, or nothing at the end. Empty lines and notes are skipped.
  Result<std::optional<Input>> next();

  /// The same, or a note of an exported log.
  using Item = std::variant<Frame, Event, ReplayNote>;
  Result<std::optional<Item>> next_item();

  /// The world has so many dimensions from here on.
  void set_dims(int dims) { dims_ = dims; }

  /// Where the last one stood, for messages: "frames.jsonl:12" or "log.lcm: event 12".
  std::string position() const;

 private:
  std::string path_;
  std::ifstream file_;
  std::istream* stream_ = nullptr;
  std::optional<LcmLogReader> log_;
  std::size_t line_ = 0;
  int dims_ = 3;
};

}  // namespace anchord
