#pragma once

#include <cstdlib>
#include <ctime>

namespace anchord {

/// Times are written as local ones: in the tests, UTC.
inline void use_utc() {
  setenv("TZ", "UTC", 1);
  tzset();
}

/// 2023-11-14 22:13:20 UTC (`date -u -d @1700000000`).
inline constexpr long long kT = 1'700'000'000'000'000;

}  // namespace anchord
