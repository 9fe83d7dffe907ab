#include "tools/anchorctl/log_commands.h"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>

#include "api/event_json.h"
#include "api/frame_json.h"
#include "api/lcm_log.h"
#include "daemon/log_export.h"
#include "daemon/rebuild.h"
#include "lcmtypes/channels.h"
#include "tools/anchorctl/format.h"
#include "tools/anchorctl/read_time.h"

namespace anchord {
namespace {

bool is_lcm(const std::string& file) { return file.ends_with(".lcm") || file.ends_with(".lcmlog"); }

Status write_line(std::ostream& out, const ExportedItem& item) {
  std::visit([&](const auto& one) { out << to_json(one).dump() << '\n'; }, item);
  if (!out) return Error{ErrorCode::kIo, "--output", "cannot be written"};
  return Done{};
}

Status write_message(LcmLogWriter& out, const ExportedItem& item, Utime& newest) {
  if (const auto* frame = std::get_if<Frame>(&item)) {
    newest = frame->utime;
    return out.write_frame(*frame);
  }
  if (const auto* event = std::get_if<Event>(&item)) return out.write_event(*event);
  const std::string text = to_json(std::get<ReplayNote>(item)).dump();
  return out.write(kReplayChannel, newest,
                   {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

void add_log_commands(CLI::App& app, LogCall& call) {
  CLI::App& exporting =
      *app.add_subcommand("export", "writes a span of the frame log, for anchor-replay");
  exporting.footer(
      "A daemon may run in the directory. The file says itself under which configurations the\n"
      "frames came, and what was believed before them: anchor-replay comes to the belief that the\n"
      "daemon had. TIME: 2026-11-22 18:00, yesterday 18:00, 20 min ago, ...\n");
  exporting.add_option("DIR", call.directory, "the daemon's data directory")->required();
  exporting.add_option("--from", call.from, "TIME from which on; default: all that there is");
  exporting.add_option("--to", call.to, "TIME up to which; default: the newest frame");
  exporting
      .add_option("--output", call.output,
                  "JSON lines, or an LCM log if it ends in .lcm or .lcmlog; - is standard output")
      ->capture_default_str();
  CLI::App& rebuilding = *app.add_subcommand(
      "rebuild", "folds the frame log anew: checkpoints and histories are made again");
  rebuilding.footer(
      "No daemon may run in the directory. For after a change of the program by which it believes\n"
      "otherwise; a start without this goes on from what the older one believed.\n");
  rebuilding.add_option("DIR", call.directory, "the daemon's data directory")->required();
}

Result<std::string> export_span(const LogCall& call) {
  const Utime now = clock_time();
  Utime from = 0, to = std::numeric_limits<Utime>::max() / 2;
  for (const auto& [name, text, utime] :
       {std::tuple{"--from", &call.from, &from}, std::tuple{"--to", &call.to, &to}}) {
    if (text->empty()) continue;
    const auto time = read_time(name, *text, now);
    if (!time) return time.error();
    *utime = *time;
  }
  std::ofstream file;
  const bool to_file = call.output != "-";
  if (to_file) {
    file.open(call.output, std::ios::binary);
    if (!file) return Error{ErrorCode::kIo, "--output", call.output + " cannot be written"};
  }
  std::ostream& out = to_file ? file : std::cout;
  LcmLogWriter lcm(out);
  Utime newest = from;
  const auto report = export_log(call.directory, from, to, [&](const ExportedItem& item) {
    return is_lcm(call.output) ? write_message(lcm, item, newest) : write_line(out, item);
  });
  if (!report) return report.error();
  if (!out.flush()) return Error{ErrorCode::kIo, "--output", "cannot be written"};
  if (!to_file) return std::string();
  return "wrote " + std::to_string(report->frames) + " frames and " +
         std::to_string(report->events) + " events to " + call.output + "\n";
}

Result<std::string> rebuild_log(const LogCall& call) {
  int percent = -1;
  const auto report = rebuild(call.directory, [&](std::int64_t done, std::int64_t all) {
    const int now = static_cast<int>(100 * done / all);
    if (now == percent) return;
    percent = now;
    std::fprintf(stderr, "anchorctl: %d %% of %lld frames\n", percent, static_cast<long long>(all));
  });
  if (!report) return report.error();
  return "folded " + std::to_string(report->folded) + " frames and events anew, from number " +
         std::to_string(report->first) + " on; checkpoints of " +
         bytes(static_cast<double>(report->checkpoints)) + "\n";
}

}  // namespace anchord
