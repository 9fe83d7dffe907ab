#pragma once

#include <optional>

#include "api/http_message.h"
#include "core/result.h"
#include "core/time.h"

namespace anchord {

/// Takes the parameter `at` out of a question: the time for which it is asked, microseconds since
/// 1970, or `now`, which is `clock`. Nothing: it has none. kInvalid: it stands there twice, or is
/// no time of the years 2000 to 2100.
Result<std::optional<Utime>> take_at(HttpTarget& target, Utime clock);

/// A time as such a parameter gives it; `name` for the refusal.
Result<Utime> read_utime(const std::string& name, const std::string& text);

}  // namespace anchord
