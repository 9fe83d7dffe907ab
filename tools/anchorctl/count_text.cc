#include <algorithm>

#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"

namespace anchord {

std::string count_text(const Json& answer, const Style& style) {
  constexpr double kVisible = 0.005;  // what two decimals show
  std::vector<std::pair<double, std::size_t>> counts;
  const auto distribution = numbers(answer, "distribution");
  for (std::size_t n = 0; n < distribution.size(); ++n) counts.emplace_back(distribution[n], n);
  std::stable_sort(counts.begin(), counts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string line;
  for (const auto& [p, n] : counts) {
    if (!line.empty() && p < kVisible) break;
    line += (line.empty() ? "" : "  ") + std::to_string(n) + " (" + probability(p) + ")";
  }
  std::string written = bold(line.empty() ? "-" : cut(line, style.width), style) + "\n";
  Table table({{""}, {""}});
  if (const auto expected = number(answer, "expected")) {
    table.add({"expected", decimal(*expected)});
  }
  if (const auto undetected = number(answer, "undetected")) {
    table.add({"not yet seen", decimal(*undetected) + " more expected"});
  }
  return written + table.text(style) +
         dim("newest frame " + date_and_time(utime(answer, "utime")), style) + "\n";
}

}  // namespace anchord
