#pragma once

#include <string>

#include "core/result.h"
#include "core/time.h"

namespace anchord {

/// A time as people write it: `now`; `2026-11-22 18:00[:05]`, `18:00[:05]`, which is today's,
/// `today 18:00`, `yesterday 18:00`, all in the local time zone; `20 min ago` (s, min, h, days); or
/// microseconds since 1970. `name` begins a refusal; `now` is the clock's.
Result<Utime> read_time(const std::string& name, const std::string& text, Utime now);

/// What the clock says.
Utime clock_time();

}  // namespace anchord
