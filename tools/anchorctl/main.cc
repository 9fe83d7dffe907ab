// anchorctl: asks and tells the daemon over HTTP, and writes its answers for people.

#include <chrono>
#include <cstdio>
#include <exception>

#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/command_line.h"
#include "tools/anchorctl/daemon.h"
#include "tools/anchorctl/event.h"
#include "tools/anchorctl/task_wait.h"
#include "tools/anchorctl/terminal.h"
#include "tools/anchorctl/watch.h"

namespace anchord {
namespace {

constexpr double kLateAnswer_s = 1;  ///< an answer may come so much after `watch --for` is over

double now_s() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

void note(const std::string& line) {
  std::fprintf(stderr, "anchorctl: %s\n", printable(line).c_str());
}

int fail(const Error& error) {
  note(error.text());
  return kFailed;
}

int show(const std::string& text) {
  if (print(text)) return 0;
  return fail({ErrorCode::kIo, "standard output", "cannot be written to"});
}

Result<Answer> ask_once(const Call& call, const HttpCall& asked) {
  return ask(call.server, asked, [] { return false; });
}

/// The daemon's JSON as it came, as a line.
std::string as_it_came(const Answer& answer) {
  return answer.text + (answer.text.ends_with('\n') ? "" : "\n");
}

std::string written(const Call& call, const Answer& answer) {
  if (call.json) return as_it_came(answer);
  const Style style = terminal_style();
  if (call.command == "where") return where_text(answer.json, style);
  if (call.command == "objects") return objects_text(answer.json, style);
  if (call.command == "count") return count_text(answer.json, style);
  if (call.command == "history") return history_text(answer.json, style);
  if (call.command == "hypotheses") return hypotheses_text(answer.json, style);
  return status_text(answer.json, call.server.text(), style);
}

int run_once(const Call& call) {
  const auto answer = ask_once(call, call.asked);
  return answer ? show(written(call, *answer)) : fail(answer.error());
}

int run_event(const Call& call) {
  const auto answer =
      tell(call.event, [&](const HttpCall& asked) { return ask_once(call, asked); });
  if (!answer) return fail(answer.error());
  return show(call.json ? as_it_came(*answer) : event_text(call.event, answer->json));
}

int run_task_list(const Call& call) {
  const auto answer = ask_once(call, call.asked);
  if (!answer) return fail(answer.error());
  if (call.json) return show(as_it_came(*answer));
  const auto status = ask_once(call, {"GET", "/v1/status", ""});
  if (!status) return fail(status.error());
  return show(verify_text(answer->json, utime(status->json, "utime"), call.all, terminal_style()));
}

int run_verify(const Call& call) {
  if (call.asked.method == "GET") return run_task_list(call);
  const auto answer = ask_once(call, call.asked);
  if (!answer) return fail(answer.error());
  const auto tell_of = [&](const Answer& task) {
    return show(call.json ? as_it_came(task) : task_text(task.json));
  };
  if (!call.wait) return tell_of(*answer);
  if (!call.json && !has_ended(answer->json)) (void)tell_of(*answer);
  const StopSignals signals;
  const auto end =
      wait_for_end(*answer, {[&](const std::string& target) {
                               return ask(call.server, {"GET", target, ""}, StopSignals::stopped);
                             },
                             now_s, StopSignals::wait, note});
  if (!end) return fail(end.error());
  const int shown = tell_of(*end);
  return went_well(end->json) ? shown : kFailed;
}

/// What works on a data directory.
int run_on_log(const Call& call) {
  const auto text = call.command == "repair"   ? repair(call.repair)
                    : call.command == "export" ? export_span(call.log)
                                               : rebuild_log(call.log);
  return text ? show(*text) : fail(text.error());
}

int run_watch(const Call& call) {
  using Output = WatchSettings::Output;
  const bool screen = !call.json && on_terminal();
  const WatchSettings settings{call.asked.target, call.server.text(),
                               call.json ? Output::kJson
                               : screen  ? Output::kScreen
                                         : Output::kChanges,
                               call.interval_s, call.for_s};
  const StopSignals signals;
  const double start_s = now_s();
  const auto given_up = [&] {
    return StopSignals::stopped() ||
           (call.for_s && now_s() > start_s + *call.for_s + kLateAnswer_s);
  };
  const WatchSeams seams{[&](const std::string& target) {
                           return ask(call.server, {"GET", target, ""}, given_up);
                         },
                         now_s,
                         StopSignals::wait,
                         terminal_style,
                         print,
                         note};
  if (screen) print("\x1b[?25l\x1b[2J");  // hides the cursor, clears
  const Status watched = watch(settings, seams);
  if (screen) print("\x1b[?25h");
  return watched || StopSignals::stopped() ? 0 : fail(watched.error());
}

}  // namespace
}  // namespace anchord

int main(int argc, char** argv) {
  try {
    const auto call = anchord::parse_command_line(argc, argv);
    if (const int* status = std::get_if<int>(&call)) return *status;
    const auto& asked = std::get<anchord::Call>(call);
    if (asked.command == "watch") return anchord::run_watch(asked);
    if (asked.command == "verify") return anchord::run_verify(asked);
    if (asked.command == "event") return anchord::run_event(asked);
    for (const char* command : {"repair", "export", "rebuild"})
      if (asked.command == command) return anchord::run_on_log(asked);
    return anchord::run_once(asked);
  } catch (const std::exception& error) {
    return anchord::fail({anchord::ErrorCode::kIo, "", error.what()});
  }
}
