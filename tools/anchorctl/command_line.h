#pragma once

#include <optional>
#include <string>
#include <variant>

#include "tools/anchorctl/fields.h"
#include "tools/anchorctl/http_client.h"
#include "tools/anchorctl/log_commands.h"
#include "tools/anchorctl/repair.h"

namespace anchord {

/// Exit statuses beside 0.
inline constexpr int kFailed = 1, kWrongCall = 2;

/// One call of the program.
struct Call {
  /// where, objects, count, hypotheses, history, watch, status, verify, repair, export, rebuild;
  /// event for all that tell one.
  std::string command;
  ServerAddress server;
  HttpCall asked;     ///< of the daemon
  Json event;         ///< event: what is told, without its utime
  bool json = false;  ///< the daemon's answer as it came
  bool wait = false;  ///< verify: until the task has ended
  bool all = false;   ///< verify: those that have ended, too
  double interval_s = 0.5;
  std::optional<double> for_s;
  RepairCall repair;
  LogCall log;  ///< export, rebuild
};

/// Reads the arguments, ANCHORD_SERVER and ANCHORD_TOKEN_FILE for what is missing, and the token.
/// If there is nothing to do, the exit status: 0 after help, kWrongCall after one line on standard
/// error about what is wrong.
std::variant<Call, int> parse_command_line(int argc, const char* const* argv);

}  // namespace anchord
