// anchorctl: asks the daemon over HTTP and writes its answers for people.

#include <chrono>
#include <cstdio>
#include <exception>

#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/command_line.h"
#include "tools/anchorctl/daemon.h"
#include "tools/anchorctl/terminal.h"
#include "tools/anchorctl/watch.h"

namespace anchord {
namespace {

constexpr double kLateAnswer_s = 1;  ///< an answer may come so much after `watch --for` is over

double now_s() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

int fail(const Error& error) {
  std::fprintf(stderr, "anchorctl: %s\n", printable(error.text()).c_str());
  return kFailed;
}

std::string written(const Call& call, const Answer& answer) {
  if (call.json) return answer.text + (answer.text.ends_with('\n') ? "" : "\n");
  const Style style = terminal_style();
  if (call.command == "where") return where_text(answer.json, style);
  if (call.command == "objects") return objects_text(answer.json, style);
  if (call.command == "count") return count_text(answer.json, style);
  if (call.command == "hypotheses") return hypotheses_text(answer.json, style);
  return status_text(answer.json, call.server.text(), style);
}

int run_once(const Call& call) {
  const auto answer = ask(call.server, call.target, [] { return false; });
  if (!answer) return fail(answer.error());
  if (print(written(call, *answer))) return 0;
  return fail({ErrorCode::kIo, "standard output", "cannot be written to"});
}

int run_watch(const Call& call) {
  using Output = WatchSettings::Output;
  const bool screen = !call.json && on_terminal();
  const WatchSettings settings{call.target, call.server.text(),
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
  const WatchSeams seams{
      [&](const std::string& target) { return ask(call.server, target, given_up); },
      now_s,
      StopSignals::wait,
      terminal_style,
      print,
      [](const std::string& line) {
        std::fprintf(stderr, "anchorctl: %s\n", printable(line).c_str());
      }};
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
    return asked.command == "watch" ? anchord::run_watch(asked) : anchord::run_once(asked);
  } catch (const std::exception& error) {
    return anchord::fail({anchord::ErrorCode::kIo, "", error.what()});
  }
}
