#include "tools/anchorctl/format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "tools/anchorctl/table.h"

namespace anchord {
namespace {

constexpr double kNegligible = 0.01;  ///< symbols less probable are not written

std::optional<std::tm> local_time(Utime utime) {
  const auto seconds = static_cast<std::time_t>(utime / 1'000'000);
  std::tm time{};
  if (!localtime_r(&seconds, &time)) return std::nullopt;
  return time;
}

std::string written(const std::tm& time, const char* how) {
  std::array<char, 64> buffer{};
  return {buffer.data(), std::strftime(buffer.data(), buffer.size(), how, &time)};
}

}  // namespace

std::string probability(std::optional<double> p) {
  if (!p) return "-";
  if (*p <= 0 || *p >= 1) return decimal(*p, 2);
  if (*p < 0.001) return "<0.001";
  if (*p > 0.999) return ">0.999";
  return decimal(*p, *p < 0.01 || *p > 0.99 ? 3 : 2);
}

std::string decimal(double value, int decimals) {
  std::array<char, 64> buffer{};
  const bool large = !(std::fabs(value) < 1e9);
  std::snprintf(buffer.data(), buffer.size(), large ? "%.*e" : "%.*f", decimals, value);
  return buffer.data();
}

std::string duration(double seconds) {
  const double size = std::fabs(seconds);
  const auto in = [&](double unit, const char* name) {
    const double value = seconds / unit;
    const double digits = std::fabs(value);
    return decimal(value, digits < 1 ? 2 : digits < 9.95 ? 1 : 0) + " " + name;
  };
  if (seconds == 0) return "0 s";
  if (size < 0.0995) return in(1e-3, "ms");
  if (size < 99.5) return in(1, "s");
  if (size < 99.5 * 60) return in(60, "min");
  if (size < 48 * 3600) return in(3600, "h");
  return in(24 * 3600, "days");
}

std::string bytes(double count) {
  constexpr std::array kUnits{"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (count >= 999.5 && unit + 1 < kUnits.size()) count /= 1000, ++unit;
  return decimal(count, unit == 0 || count >= 99.5 ? 0 : 1) + " " + kUnits[unit];
}

std::string date_and_time(std::optional<Utime> utime) {
  const auto time = utime ? local_time(*utime) : std::nullopt;
  return time ? written(*time, "%Y-%m-%d %H:%M:%S %Z") : "-";
}

std::string time_near(std::optional<Utime> utime, std::optional<Utime> newest) {
  const auto time = utime ? local_time(*utime) : std::nullopt;
  if (!time) return "-";
  const auto last = newest ? local_time(*newest) : std::nullopt;
  const bool same_day = last && last->tm_yday == time->tm_yday && last->tm_year == time->tm_year;
  return written(*time, same_day ? "%H:%M:%S" : "%Y-%m-%d %H:%M:%S");
}

std::string seen(std::optional<Utime> utime, std::optional<Utime> newest) {
  const std::string when = time_near(utime, newest);
  if (!newest || when == "-") return when;
  const double age_s = seconds_between(*utime, *newest);
  if (age_s == 0) return when + " (now)";
  const std::string span = age_s < 0 ? "in " + duration(-age_s) : duration(age_s) + " ago";
  return when + " " + glued("(" + span + ")");
}

std::string time_of_day(std::optional<Utime> utime) {
  const auto time = utime ? local_time(*utime) : std::nullopt;
  return time ? written(*time, "%H:%M:%S") : "-";
}

std::string position(const std::vector<double>& position, const std::vector<double>& covariance) {
  std::string written;
  for (const double axis : position) written += (written.empty() ? "" : ", ") + decimal(axis);
  if (written.empty()) return "-";
  const auto sigmas = axis_sigmas(covariance, position.size());
  if (!sigmas.empty()) written += " ±" + decimal(*std::max_element(sigmas.begin(), sigmas.end()));
  return written;
}

std::vector<double> axis_sigmas(const std::vector<double>& covariance, std::size_t dimensions) {
  if (covariance.size() != dimensions * dimensions) return {};
  std::vector<double> sigmas;
  for (std::size_t axis = 0; axis < dimensions; ++axis) {
    sigmas.push_back(std::sqrt(std::max(0.0, covariance[axis * (dimensions + 1)])));
  }
  return sigmas;
}

std::string class_of(const Json& object) {
  const Json* found = member(object, "class");
  if (!found) found = member(items(object, "attributes"), "class");
  if (!found) return "-";
  if (found->is_string()) return printable(found->get_ref<const std::string&>());
  const std::string all = attribute(*found);
  return all.substr(0, all.find(','));
}

std::string attribute(const Json& value) {
  if (const auto mean = number(value, "mean")) {
    std::string written = decimal(*mean, 3);
    if (const auto variance = number(value, "variance")) {
      written += " ±" + decimal(std::sqrt(std::max(0.0, *variance)), 3);
    }
    const std::string unit = text(value, "unit", "");
    return written + (unit.empty() ? "" : " " + unit);
  }
  std::vector<std::pair<double, std::string>> symbols;
  if (value.is_object()) {
    for (const auto& [symbol, p] : value.items()) {
      if (p.is_number() && p.get<double>() >= kNegligible) {
        symbols.emplace_back(p.get<double>(), printable(symbol));
      }
    }
  }
  std::stable_sort(symbols.begin(), symbols.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string written;
  for (const auto& [p, symbol] : symbols) {
    written += (written.empty() ? "" : ", ") + glued(symbol + " " + probability(p));
  }
  return written.empty() ? "-" : written;
}

}  // namespace anchord
