#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"

namespace anchord {
namespace {

std::string where(const Json& event) {
  const bool moved = text(event, "event") == "moved";
  const auto at = numbers(event, "position");
  if (!at.empty()) return (moved ? " to " : " at ") + position(at) + " m";
  const std::string place = text(event, "place", "");
  return place.empty() ? "" : (moved ? " to " : " in ") + place;
}

std::string what(const Json& event) {
  const std::string kind = text(event, "event"), object = text(event, "object");
  if (kind == "named") {
    const std::string name = text(event, "name", "");
    return object + (name.empty() ? " has no other name now" : " is called \"" + name + "\" now");
  }
  if (kind == "joined") return text(event, "other") + " is " + object + " now";
  if (kind == "dropped") return object + " is no object any more";
  if (kind == "undone") {
    const auto which = number(event, "number");
    return "event " + (which ? decimal(*which, 0) : "-") + " is taken back";
  }
  const std::string robot = text(event, "robot", "");
  return object + " was " + kind + where(event) + (robot.empty() ? "" : " by " + robot);
}

}  // namespace

std::string event_text(const Json& event, const Json& answer) {
  const auto its = number(answer, "number");
  const std::string number = its ? decimal(*its, 0) : "-";
  const std::string kind = text(event, "event");
  std::string line = what(event) + " (event " + number;
  if (kind == "named" || kind == "joined" || kind == "dropped")
    line += "; take it back with anchorctl undo " + number;
  else if (kind != "undone")
    line += "; it cannot be undone: tell what is so now";
  return line + ")\n";
}

}  // namespace anchord
