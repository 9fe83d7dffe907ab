#include "tools/anchorctl/read_time.h"

#include <time.h>

#include <charconv>
#include <chrono>
#include <optional>
#include <sstream>

namespace anchord {
namespace {

constexpr Utime kSecond = 1'000'000;

std::optional<tm> parsed(const std::string& text, const char* format, tm time) {
  const char* rest = strptime(text.c_str(), format, &time);
  if (!rest || *rest != '\0') return {};
  time.tm_isdst = -1;
  return time;
}

/// A date and a time of day.
std::optional<tm> moment(const std::string& text, const tm& today) {
  for (const char* format : {"%Y-%m-%d %H:%M:%S", "%Y-%m-%d %H:%M", "%Y-%m-%d"})
    if (auto time = parsed(text, format, tm{})) return time;
  std::string rest = text;
  int days = 0;
  for (const auto& [word, ago] : {std::pair{"today ", 0}, std::pair{"yesterday ", 1}})
    if (text.starts_with(word)) {
      rest = text.substr(std::string(word).size());
      days = ago;
    }
  tm midnight = today;
  midnight.tm_hour = midnight.tm_min = midnight.tm_sec = 0;
  midnight.tm_mday -= days;
  for (const char* format : {"%H:%M:%S", "%H:%M"})
    if (auto time = parsed(rest, format, midnight)) return time;
  return {};
}

/// "20 min ago".
std::optional<Utime> ago(const std::string& text, Utime now) {
  std::istringstream words(text);
  double number = 0;
  std::string unit, last, more;
  if (!(words >> number >> unit >> last) || last != "ago" || (words >> more) || number < 0 ||
      !(number < 1e9))
    return {};
  const struct {
    const char* name;
    double seconds;
  } units[] = {{"s", 1},       {"min", 60},     {"h", 3600},    {"hours", 3600},
               {"hour", 3600}, {"days", 86400}, {"day", 86400}, {"minutes", 60}};
  for (const auto& [name, seconds] : units)
    if (unit == name) return now - from_seconds(number * seconds);
  return {};
}

}  // namespace

Utime clock_time() {
  using std::chrono::microseconds;
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<microseconds>(since_1970).count();
}

Result<Utime> read_time(const std::string& name, const std::string& text, Utime now) {
  if (text == "now") return now;
  Utime utime = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), utime);
  if (fault == std::errc() && end == text.data() + text.size()) return utime;
  if (const auto before = ago(text, now)) return *before;
  const time_t seconds = static_cast<time_t>(now / kSecond);
  tm today{};
  localtime_r(&seconds, &today);
  if (auto time = moment(text, today)) return static_cast<Utime>(mktime(&*time)) * kSecond;
  return invalid(name,
                 "must be now, a time such as 2026-11-22 18:00, yesterday 18:00, 18:00 or 20 min "
                 "ago, or microseconds since 1970");
}

}  // namespace anchord
