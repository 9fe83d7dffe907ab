#include "tools/anchorctl/repair.h"

#include <utility>

#include "lcmtypes/checked_decode.h"
#include "lcmtypes/event_codec.h"
#include "tools/anchorctl/read_time.h"

namespace anchord {
namespace {

bool readable(const LoggedFrame& frame) {
  if (frame.kind == LoggedFrame::Kind::kEvent) return decode_event(frame.bytes).ok();
  return frame.kind == LoggedFrame::Kind::kFrame && decode_frame(frame.bytes).ok();
}

}  // namespace

void add_repair_command(CLI::App& app, RepairCall& call) {
  CLI::App& command =
      *app.add_subcommand("repair", "saves what can be saved of a damaged frame log");
  command.footer(
      "No daemon may run in the directory. A new anchord.db is made of every frame and event that\n"
      "is whole; the old one stays beside it as anchord.db.corrupt-1.\n");
  command.add_option("DIR", call.directory, "the daemon's data directory")->required();
  command.add_option("--until", call.until,
                     "leave out what is later: now, 2026-11-22 18:00, or microseconds since 1970");
  command.add_flag("--without-events", call.without_events, "leave out events");
  command.add_flag("--all-events", call.all_events,
                   "keep events behind what is lost, though what they name may be another thing");
}

Result<std::string> repair(const RepairCall& call) {
  RepairOptions options{readable, {}, !call.without_events, call.all_events};
  if (!call.until.empty()) {
    const auto until = read_time("--until", call.until, clock_time());
    if (!until) return until.error();
    options.until = *until;
  }
  const auto report = repair_log(call.directory, options);
  if (!report) return report.error();
  return repair_text(*report);
}

std::string repair_text(const RepairReport& report) {
  std::string text = "saved " + std::to_string(report.saved) + " frames and events, and " +
                     std::to_string(report.tasks) + " verification tasks\n";
  std::int64_t lost = 0;
  std::string ranges;
  for (const auto& [first, last] : report.lost) {
    lost += last - first + 1;
    ranges += (ranges.empty() ? " " : ", ") + std::to_string(first) +
              (last > first ? " to " + std::to_string(last) : "");
  }
  text += lost == 0 ? "nothing that was acknowledged is known to be lost\n"
                    : "lost " + std::to_string(lost) + ": number" + ranges + " of the old log\n";
  if (report.base_lost)
    text += "what had been given up before is lost, too: the belief begins with what is left\n";
  if (const std::int64_t asked = report.left_out - report.doubtful; asked > 0)
    text += "left out " + std::to_string(asked) + " as asked\n";
  if (report.doubtful > 0)
    text += "left out " + std::to_string(report.doubtful) +
            " events behind what is lost: they may name something else now (--all-events)\n";
  return text + "the old database is kept as " + report.kept_as + "\n";
}

}  // namespace anchord
