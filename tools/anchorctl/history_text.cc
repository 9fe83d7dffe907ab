#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"

namespace anchord {

std::string history_text(const Json& answer, const Style& style) {
  const auto newest = utime(answer, "utime");
  Table table({{"FROM"}, {"P"}, {"PLACE"}, {"POSITION [m]"}});
  for (const Json& sample : items(answer, "samples")) {
    const auto p = number(sample, "p");
    const auto spread = number(sample, "spread");
    const std::string where =
        position(numbers(sample, "position")) + (spread ? " \u00b1" + decimal(*spread) : "");
    const bool gone = p.value_or(1) <= 0;
    table.add({time_near(utime(sample, "utime"), newest), gone ? "gone" : probability(p),
               gone ? "" : text(sample, "place", "elsewhere"), gone ? "" : where},
              p.value_or(1) < 0.5);
  }
  const std::string name = text(answer, "object");
  if (table.empty()) return "nothing is known of " + name + " in that time\n";
  return table.text(style) + dim("newest frame " + date_and_time(newest), style) + "\n";
}

}  // namespace anchord
