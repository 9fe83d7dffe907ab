#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/result.h"
#include "tools/anchorctl/daemon.h"
#include "tools/anchorctl/table.h"

namespace anchord {

struct WatchSettings {
  enum class Output {
    kScreen,   ///< redraws a table
    kChanges,  ///< a line per change
    kJson,     ///< the daemon's answer whenever it differs from the one before
  };
  std::string objects_target;  ///< of GET /v1/objects
  std::string server;          ///< where the daemon is, for people
  Output output = Output::kChanges;
  double interval_s = 0.5;
  std::optional<double> for_s;  ///< stops after so long; never if missing
};

/// What watch() sees of the machine.
struct WatchSeams {
  std::function<Result<Answer>(const std::string& target)> fetch;
  std::function<double()> now_s;                  ///< a clock that never goes back
  std::function<bool(double s)> wait;             ///< false: asked to stop
  std::function<Style()> style;                   ///< the terminal's size may change
  std::function<bool(const std::string&)> print;  ///< to standard output; false: it is closed
  std::function<void(const std::string&)> note;   ///< one line to standard error
};

/// Shows the objects until it is asked to stop or the time is over. Where the daemon does not
/// answer it waits for it. Errors: the daemon refuses the question; the time is over and the
/// daemon has never answered; the output is closed.
Status watch(const WatchSettings& settings, const WatchSeams& seams);

}  // namespace anchord
