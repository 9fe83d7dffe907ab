#pragma once

#include <cstdint>

namespace anchord {

/// Microseconds since 1970-01-01 UTC, as in LCM types.
using Utime = std::int64_t;

/// The times a frame may carry: the years 2000 to 2100.
inline constexpr Utime kEarliestUtime = 946'684'800'000'000;
inline constexpr Utime kLatestUtime = 4'102'444'800'000'000;

/// Seconds from `from` to `to`.
inline constexpr double seconds_between(Utime from, Utime to) {
  return static_cast<double>(to - from) * 1e-6;
}

/// The nearest microsecond to a span in seconds.
inline constexpr Utime from_seconds(double seconds) {
  return static_cast<Utime>(seconds * 1e6 + (seconds < 0 ? -0.5 : 0.5));
}

}  // namespace anchord
