#pragma once

#include <cstdint>
#include <vector>

#include "core/time.h"

namespace anchord {

/// A belief after some of the log, as bytes: what a start goes on from instead of folding it all.
struct StoredCheckpoint {
  std::int64_t sequence = 0;         ///< of the last frame or event that is in it
  std::uint32_t frame_checksum = 0;  ///< checksum() of that: the same log goes on from here
  std::uint64_t configuration = 0;   ///< Knowledge::fingerprint
  std::vector<std::uint8_t> bytes;
  /// Of the newest frame in it; 0: not known, one of before this was kept.
  Utime utime = 0;
  bool operator==(const StoredCheckpoint&) const = default;
};

/// CRC-32 of its bytes.
std::uint32_t checksum(const StoredCheckpoint& checkpoint);

}  // namespace anchord
