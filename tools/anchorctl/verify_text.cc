#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"

namespace anchord {
namespace {

bool is_open(const Json& task) {
  const std::string state = text(task, "state");
  return state == "queued" || state == "issued";
}

std::string id_of(const Json& task) {
  const auto id = number(task, "id");
  return id ? decimal(*id, 0) : "-";
}

/// How long it took, if it has ended: " after 3.2 s".
std::string lifetime(const Json& task) {
  const auto created = utime(task, "created"), ended = utime(task, "ended");
  return created && ended ? " after " + duration(seconds_between(*created, *ended)) : "";
}

/// Until when it lives, or when it has ended.
std::string until(const Json& task, std::optional<Utime> newest) {
  if (is_open(task)) return time_near(utime(task, "deadline"), newest);
  return time_near(utime(task, "ended"), newest) + glued(lifetime(task));
}

std::string sensor_of(const Json& task) {
  const std::string sensor = text(task, "sensor", ""), robot = text(task, "robot", "");
  if (robot.empty()) return sensor.empty() ? "-" : sensor;
  return (sensor.empty() ? "any" : sensor) + " of " + robot;
}

/// Without a sensor nothing was computed: the robot's pose was not known.
std::string amount(const Json& task, const char* name) {
  if (!member(task, "sensor")) return "-";
  const auto value = number(task, name);
  return value ? decimal(*value) : "-";
}

}  // namespace

std::string verify_text(const Json& answer, std::optional<Utime> newest, bool all,
                        const Style& style) {
  Table table({{"TASK"},
               {"STATE"},
               {"OBJECT"},
               {"SENSOR"},
               {"GAIN [nat]"},
               {"COST"},
               {"UNTIL / ENDED", true},
               {"REASON", true}});
  std::size_t left_out = 0;
  for (const Json& task : items(answer, "verifications")) {
    const bool open = is_open(task);
    if (!open && !all) {
      ++left_out;
      continue;
    }
    table.add(
        {id_of(task), text(task, "state"), text(task, "object"), sensor_of(task),
         amount(task, "gain"), amount(task, "cost"), until(task, newest), text(task, "reason")},
        !open);
  }
  std::string written = !table.empty() ? table.text(style) : all ? "no task\n" : "no open task\n";
  if (left_out > 0)
    written += std::to_string(left_out) + (left_out == 1 ? " has" : " have") +
               " ended (anchorctl verify --all)\n";
  return written + dim("newest frame " + date_and_time(newest), style) + "\n";
}

std::string task_text(const Json& task) {
  const std::string state = text(task, "state");
  if (!number(task, "id")) return "no look is needed for that\n";
  std::string line = "task " + id_of(task) + " (" + text(task, "object") + "): " + state;
  if (is_open(task)) return line + ", until " + time_of_day(utime(task, "deadline")) + "\n";
  line += lifetime(task);
  const std::string reason = text(task, "reason", "");
  return line + (reason.empty() ? "" : ", " + reason) + "\n";
}

}  // namespace anchord
