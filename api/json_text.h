#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/result.h"

namespace anchord {

/// How deep arrays and objects may stand inside each other.
inline constexpr std::size_t kMaxJsonDepth = 32;

/// Untrusted text as JSON. Refused: more than kMaxMessageBytes, invalid JSON or UTF-8 (with the
/// byte where it ends to make sense), numbers that no double holds, nesting deeper than
/// kMaxJsonDepth, an object that names a member twice. The message never quotes the text.
Result<nlohmann::json> parse_json(std::string_view text);

}  // namespace anchord
