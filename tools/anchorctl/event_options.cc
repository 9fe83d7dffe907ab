#include "tools/anchorctl/event_options.h"

namespace anchord {
namespace {

constexpr const char* kObject = "its id, or what people call it";

}  // namespace

void add_event_commands(CLI::App& app, EventOptions& options,
                        const std::function<void(CLI::App&)>& common) {
  const auto add = [&](const char* name, const char* what) -> CLI::App& {
    CLI::App& command = *app.add_subcommand(name, what);
    common(command);
    return command;
  };
  const auto object = [&](CLI::App& command) {
    command.add_option("OBJECT", options.object, kObject)->required();
  };

  CLI::App& name = add("name", "gives an object a name of your own; \"\" takes it back");
  object(name);
  name.add_option("ALIAS", options.other, "the name")->required();

  CLI::App& join = add("join", "says that two objects are one");
  join.add_option("OBJECT", options.object, "the one whose name stays")->required();
  join.add_option("OTHER", options.other, "the one that it is, too")->required();

  object(add("drop", "says that there never was such an object"));

  add("undo", "takes back a name, join or drop")
      .add_option("NUMBER", options.number, "the event's, which was told then")
      ->required()
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53));

  CLI::App& event = add("event", "tells what was done to an object");
  event.add_option("WHAT", options.kind, "grasped, placed, moved or removed")
      ->required()
      ->check(CLI::IsMember({"grasped", "placed", "moved", "removed"}));
  object(event);
  event.add_option("--place", options.place, "placed, moved: somewhere in that place");
  event.add_option("--at", options.at, "placed, moved: X Y [Z], metres, in the map")
      ->expected(2, 3);
  event.add_option("--robot", options.robot, "who did it; default: the only one");
}

bool is_event_command(const std::string& command) {
  return command == "name" || command == "join" || command == "drop" || command == "undo" ||
         command == "event";
}

Result<Json> event_body(const std::string& command, const EventOptions& options) {
  if (command == "undo") return Json{{"event", "undone"}, {"number", options.number}};
  if (options.object.empty()) return invalid("OBJECT", "is empty");
  if (command == "name")
    return Json{{"event", "named"}, {"object", options.object}, {"name", options.other}};
  if (command == "join")
    return Json{{"event", "joined"}, {"object", options.object}, {"other", options.other}};
  if (command == "drop") return Json{{"event", "dropped"}, {"object", options.object}};

  Json body{{"event", options.kind}, {"object", options.object}};
  const bool goes_somewhere = options.kind == "placed" || options.kind == "moved";
  if (!options.place.empty() && !options.at.empty())
    return invalid("--at", "does not go with --place: the position says it all");
  if (!options.place.empty()) {
    if (!goes_somewhere) return invalid("--place", "is for what is placed or moved");
    body["place"] = options.place;
  }
  if (!options.at.empty()) {
    if (!goes_somewhere) return invalid("--at", "is for what is placed or moved");
    body["position"] = options.at;
  }
  if (!options.robot.empty()) body["robot"] = options.robot;
  return body;
}

}  // namespace anchord
