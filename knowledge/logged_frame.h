#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace anchord {

/// One accepted frame, or event, as it stands in the log.
struct LoggedFrame {
  enum class Kind { kFrame = 0, kEvent = 1 };
  Kind kind = Kind::kFrame;
  std::int64_t sequence = 0;  ///< order of acceptance, from 1, without a gap
  Utime utime = 0;
  std::string robot, sensor;
  std::vector<std::uint8_t> bytes;        ///< its canonical encoding; the log does not read it
  std::optional<std::int64_t> work = {};  ///< bound on the work that folding it took, if there was
  bool operator==(const LoggedFrame&) const = default;
};

/// CRC-32 of all of it, which the log keeps beside it.
std::uint32_t checksum(const LoggedFrame& frame);

}  // namespace anchord
