#include "api/at_parameter.h"

#include <algorithm>
#include <charconv>

namespace anchord {

Result<Utime> read_utime(const std::string& name, const std::string& text) {
  Utime utime = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), utime);
  if (fault != std::errc() || end != text.data() + text.size() || utime < kEarliestUtime ||
      utime > kLatestUtime)
    return invalid(name, "must be microseconds since 1970, in the years 2000 to 2100");
  return utime;
}

Result<std::optional<Utime>> take_at(HttpTarget& target, Utime clock) {
  auto& parameters = target.parameters;
  const auto is_at = [](const auto& parameter) { return parameter.first == "at"; };
  const auto found = std::find_if(parameters.begin(), parameters.end(), is_at);
  if (found == parameters.end()) return std::optional<Utime>();
  const std::string text = found->second;
  parameters.erase(found);
  if (std::any_of(parameters.begin(), parameters.end(), is_at))
    return invalid("at", "is given twice");
  if (text == "now") return std::optional(clock);
  const auto utime = read_utime("at", text);
  if (!utime)
    return invalid("at", "must be now, or microseconds since 1970, in the years 2000 to 2100");
  return std::optional(*utime);
}

}  // namespace anchord
