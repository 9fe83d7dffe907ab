#include "tools/anchorctl/fields.h"

#include <cmath>

namespace anchord {

const Json* member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

std::optional<double> number(const Json& object, const char* name) {
  const Json* found = member(object, name);
  if (!found || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::optional<Utime> utime(const Json& object, const char* name) {
  const auto value = number(object, name);
  if (!value || *value < kEarliestUtime || *value > kLatestUtime) return std::nullopt;
  return member(object, name)->get<Utime>();
}

bool flag(const Json& object, const char* name) {
  const Json* found = member(object, name);
  return found && found->is_boolean() && found->get<bool>();
}

std::string text(const Json& object, const char* name, const std::string& missing) {
  const Json* found = member(object, name);
  return found && found->is_string() ? printable(found->get_ref<const std::string&>()) : missing;
}

const Json& items(const Json& object, const char* name) {
  static const Json kNone = Json::array();
  const Json* found = member(object, name);
  return found && found->is_structured() ? *found : kNone;
}

std::vector<double> numbers(const Json& object, const char* name) {
  std::vector<double> values;
  for (const Json& value : items(object, name)) {
    if (!value.is_number()) return {};
    values.push_back(value.get<double>());
  }
  return values;
}

std::string printable(const std::string& text) {
  std::string safe;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0u;
    if (byte < 0x20 || byte == 0x7f) {
      safe += '?';
    } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {  // U+0080 to U+009F, as UTF-8
      safe += '?';
      ++i;
    } else {
      safe += text[i];
    }
  }
  return safe;
}

}  // namespace anchord
