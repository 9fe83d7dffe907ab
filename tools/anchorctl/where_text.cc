#include <algorithm>

#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"
#include "tools/anchorctl/places.h"

namespace anchord {
namespace {

constexpr double kVisible = 0.005;      ///< what two decimals show
constexpr std::size_t kMostPlaces = 8;  ///< of those where undetected ones may be

std::string undetected_text(const Json& entries, const Style& style) {
  std::vector<std::pair<double, std::string>> expected;
  for (const Json& entry : entries) {
    const double count = number(entry, "expected").value_or(0);
    if (count >= kVisible) expected.emplace_back(count, text(entry, "place", "outside"));
  }
  if (expected.empty()) return "";
  std::stable_sort(expected.begin(), expected.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Table table({{"NOT YET SEEN"}, {"EXPECTED"}});
  for (std::size_t i = 0; i < std::min(expected.size(), kMostPlaces); ++i) {
    table.add({expected[i].second, decimal(expected[i].first)});
  }
  if (expected.size() > kMostPlaces) {
    table.add({"and " + std::to_string(expected.size() - kMostPlaces) + " places more", ""});
  }
  return "\n" + table.text(style);
}

}  // namespace

std::string where_text(const Json& answer, const Style& style) {
  const auto newest = utime(answer, "utime");
  Table table(
      {{"OBJECT"}, {"P"}, {"MATCH"}, {"PLACES", true}, {"POSITION [m]"}, {"LAST SEEN", true}});
  for (const Json& each : items(answer, "answers")) {
    const auto p = number(each, "p");
    table.add({text(each, "object"), probability(p), probability(number(each, "match")),
               places(items(each, "places")),
               position(numbers(each, "position"), numbers(each, "covariance")),
               seen(utime(each, "last_seen"), newest)},
              p.value_or(1) < 0.5);
  }
  std::string written = table.empty() ? "no object that has been seen fits\n" : table.text(style);
  written += undetected_text(items(answer, "undetected"), style);
  return written + dim("newest frame " + date_and_time(newest), style) + "\n";
}

}  // namespace anchord
