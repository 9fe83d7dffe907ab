#include <algorithm>
#include <cmath>

#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"

namespace anchord {
namespace {

std::string newest_line(const Json& answer, const Style& style) {
  return dim("newest frame " + date_and_time(utime(answer, "utime")), style) + "\n";
}

/// All attributes but the class: "color blue 0.90, size 0.120 ±0.020".
std::string other_attributes(const Json& object) {
  std::string written;
  const Json& attributes = items(object, "attributes");
  if (!attributes.is_object()) return "-";
  for (const auto& [name, value] : attributes.items()) {
    if (name == "class") continue;
    std::string first = attribute(value);
    if (!number(value, "mean")) first.resize(std::min(first.find(','), first.size()));
    written += (written.empty() ? "" : ", ") + glued(printable(name) + " " + first);
  }
  return written.empty() ? "-" : written;
}

/// "cup-1", or with what people call it: "cup-1 (my mug)".
std::string name_of(const Json& object) {
  const std::string alias = text(object, "alias", "");
  return text(object, "id") + (alias.empty() ? "" : " (" + alias + ")");
}

/// "held by amigo"; nothing if no robot holds it. The only robot may have no name.
std::string holder_of(const Json& object) {
  if (!member(object, "held_by")) return "";
  const std::string robot = text(object, "held_by", "");
  return "held by " + (robot.empty() ? "the robot" : robot);
}

std::string place_of(const Json& object) {
  const std::string holder = holder_of(object);
  return text(object, "place") + (holder.empty() ? "" : ", " + holder);
}

std::string list_text(const Json& answer, const Style& style) {
  const auto newest = utime(answer, "utime");
  Table table({{"OBJECT"},
               {"P"},
               {"CLASS"},
               {"PLACE"},
               {"POSITION [m]"},
               {"LAST SEEN", true},
               {"ATTRIBUTES", true}});
  for (const Json& object : items(answer, "objects")) {
    const auto p = number(object, "p");
    table.add({name_of(object), probability(p), class_of(object), place_of(object),
               position(numbers(object, "position"), numbers(object, "covariance")),
               seen(utime(object, "last_seen"), newest), other_attributes(object)},
              p.value_or(1) < 0.5);
  }
  return (table.empty() ? "no object fits\n" : table.text(style)) + newest_line(answer, style);
}

std::string spread(const std::vector<double>& values, const std::vector<double>& sigmas) {
  std::string written;
  for (std::size_t i = 0; i < values.size(); ++i) {
    written += (i ? ", " : "") + decimal(values[i]);
    if (!sigmas.empty()) written += glued(" ±" + decimal(sigmas[i]));
  }
  return written;
}

void add_motion(const Json& object, Table& table) {
  const auto at = numbers(object, "position");
  const auto sigmas = axis_sigmas(numbers(object, "covariance"), at.size());
  if (!at.empty()) table.add({"position", spread(at, sigmas) + " m"});
  if (const auto velocity = numbers(object, "velocity"); !velocity.empty()) {
    double square = 0;
    for (const double axis : velocity) square += axis * axis;
    table.add({"velocity", spread(velocity, {}) + " m/s (" + decimal(std::sqrt(square)) + " m/s)"});
  }
  if (const auto yaw = number(object, "yaw")) {
    table.add({"yaw", decimal(*yaw) + " rad (" + decimal(*yaw * 180 / M_PI, 0) + " degrees)"});
  }
  if (const auto extent = numbers(object, "extent"); !extent.empty()) {
    table.add({"extent", spread(extent, {}) + " m"});
  }
}

std::string models_text(const Json& models, const Style& style) {
  Table table({{"MODEL"}, {"WEIGHT"}, {"PLACE"}, {"POSITION [m]"}});
  for (const Json& model : models) {
    table.add({text(model, "kind"), probability(number(model, "weight")), text(model, "place"),
               position(numbers(model, "position"), numbers(model, "covariance"))});
  }
  return table.empty() ? "" : "\n" + table.text(style);
}

std::string alternatives_text(const Json& alternatives, const Style& style) {
  Table table({{"ALTERNATIVE"}, {"PLACE"}, {"CLASS"}, {"POSITION [m]"}});
  for (const Json& each : alternatives) {
    table.add({probability(number(each, "p")), text(each, "place"), class_of(each),
               position(numbers(each, "position"), numbers(each, "covariance"))});
  }
  return table.empty() ? "" : "\n" + table.text(style);
}

std::string one_text(const Json& answer, const Style& style) {
  Table table({{""}, {"", true}});
  table.add({"object", text(answer, "id")});
  if (member(answer, "alias")) table.add({"called", text(answer, "alias")});
  const bool known = member(answer, "in_best") != nullptr;
  const std::string best = flag(answer, "in_best") ? "in the best world" : "not in the best world";
  table.add({"exists", probability(number(answer, "p")) + (known ? ", " + best : "")});
  if (const Json& attributes = items(answer, "attributes"); attributes.is_object()) {
    for (const auto& [name, value] : attributes.items()) {
      table.add({printable(name), attribute(value)});
    }
  }
  table.add({"place", place_of(answer)});
  add_motion(answer, table);
  table.add({"last seen", seen(utime(answer, "last_seen"), utime(answer, "utime"))});
  return table.text(style) + models_text(items(answer, "models"), style) +
         alternatives_text(items(answer, "alternatives"), style) + newest_line(answer, style);
}

}  // namespace

std::string objects_text(const Json& answer, const Style& style) {
  return member(answer, "id") ? one_text(answer, style) : list_text(answer, style);
}

}  // namespace anchord
