#include "lcmtypes/names.h"

#include <cstdint>
#include <unordered_set>

namespace anchord {
namespace {

/// Length in bytes of the well-formed UTF-8 character at the start of `text` (Unicode 15, table
/// 3-7), or 0.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0u;
  };
  const auto continues = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if ((byte(i) & 0xc0u) != 0x80u) return false;
    }
    return true;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xc2) return 0;
  if (first < 0xe0) return continues(1, 2) ? 2 : 0;
  if (first < 0xf0) {
    const bool overlong = first == 0xe0 && byte(1) < 0xa0;
    const bool surrogate = first == 0xed && byte(1) > 0x9f;
    return continues(1, 3) && !overlong && !surrogate ? 3 : 0;
  }
  const bool overlong = first == 0xf0 && byte(1) < 0x90;
  const bool beyond_unicode = first > 0xf4 || (first == 0xf4 && byte(1) > 0x8f);
  return continues(1, 4) && !overlong && !beyond_unicode ? 4 : 0;
}

}  // namespace

const char* text_fault(std::string_view text, std::size_t max_bytes) {
  if (text.size() > max_bytes) return "is too long";
  while (!text.empty()) {
    const auto first = static_cast<std::uint8_t>(text.front());
    if (first < 0x20 || first == 0x7f) return "must not contain control characters";
    const std::size_t length = character_length(text);
    if (length == 0) return "must be UTF-8";
    text.remove_prefix(length);
  }
  return nullptr;
}

const char* name_fault(std::string_view text) {
  return text.empty() ? "must not be empty" : text_fault(text);
}

int first_repeated(const std::vector<std::string_view>& names) {
  std::unordered_set<std::string_view> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!seen.insert(names[i]).second) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace anchord
