#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"

namespace anchord {
namespace {

std::string difference(const Json& each) {
  const std::string object = text(each, "object");
  const std::string change = text(each, "change", "differs");
  const auto at = numbers(each, "position");
  const auto best = numbers(each, "best_position");
  const std::string here = at.empty() ? "" : " at " + position(at);
  if (change == "absent") {
    return object + " is absent" + (best.empty() ? "" : " (there: at " + position(best) + ")");
  }
  if (change == "present") return object + " is present" + here;
  if (change == "moved") {
    return object + " is" + here + (best.empty() ? "" : " instead of " + position(best));
  }
  if (change == "class") {
    const std::string to = class_of(each);
    return object + " is of another class" + (to == "-" ? "" : ": " + to) + here;
  }
  return object + " " + change + here;
}

std::string first_world(const Json& world, const Style& style) {
  Table table({{"OBJECT"}, {"P"}, {"CLASS"}, {"POSITION [m]"}});
  for (const Json& object : items(world, "objects")) {
    table.add({text(object, "id"), probability(number(object, "p")), class_of(object),
               position(numbers(object, "position"))});
  }
  return table.empty() ? "Nothing exists in it.\n" : table.text(style);
}

std::string counted(std::optional<double> count, const std::string& one, const std::string& many) {
  return decimal(count.value_or(0), 0) + " " + (count == 1.0 ? one : many);
}

}  // namespace

std::string hypotheses_text(const Json& answer, const Style& style) {
  const Json& worlds = items(answer, "worlds");
  std::string written = counted(number(answer, "hypotheses"), "hypothesis", "hypotheses") + " in " +
                        counted(number(answer, "clusters"), "cluster", "clusters") + "\n";
  if (!worlds.is_array() || worlds.empty()) return written;

  written += "\n" + bold("World 1, p " + probability(number(worlds[0], "p")), style) + "\n" +
             first_world(worlds[0], style);
  Table table({{"WORLD"}, {"P"}, {"DIFFERS FROM WORLD 1", true}});
  for (std::size_t i = 1; i < worlds.size(); ++i) {
    std::string world = std::to_string(i + 1), p = probability(number(worlds[i], "p"));
    const Json& differs = items(worlds[i], "differs");
    if (differs.empty()) table.add({world, p, "in nothing that is told"});
    for (const Json& each : differs) {
      table.add({world, p, difference(each)});
      world = p = "";
    }
  }
  if (!table.empty()) written += "\n" + table.text(style);
  return written + dim("newest frame " + date_and_time(utime(answer, "utime")), style) + "\n";
}

}  // namespace anchord
