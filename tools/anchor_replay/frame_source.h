#pragma once

#include <fstream>
#include <istream>
#include <memory>
#include <optional>
#include <string>

#include "api/lcm_log.h"
#include "core/frame.h"
#include "core/result.h"

namespace anchord {

/// Frames from a file: JSON lines, or an LCM log if its name ends in `.lcm` or `.lcmlog`; "-" is
/// standard input, JSON lines.
class FrameSource {
 public:
  static Result<std::unique_ptr<FrameSource>> open(const std::string& path);

  /// The next frame, or nothing at the end. Empty lines are skipped.
  Result<std::optional<Frame>> next();

  /// Where the last frame stood, for messages: "frames.jsonl:12" or "log.lcm: event 12".
  std::string position() const;

 private:
  std::string path_;
  std::ifstream file_;
  std::istream* stream_ = nullptr;
  std::optional<LcmLogReader> log_;
  std::size_t line_ = 0;
};

}  // namespace anchord
