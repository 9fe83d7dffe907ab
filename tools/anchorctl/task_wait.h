#pragma once

#include <functional>
#include <string>

#include "core/result.h"
#include "tools/anchorctl/daemon.h"

namespace anchord {

/// What wait_for_end() sees of the machine.
struct TaskWaitSeams {
  std::function<Result<Answer>(const std::string& target)> fetch;
  std::function<double()> now_s;                 ///< a clock that never goes back
  std::function<bool(double s)> wait;            ///< false: asked to stop
  std::function<void(const std::string&)> note;  ///< one line to standard error
};

/// Whether a task has ended, or there is none to wait for.
bool has_ended(const Json& task);

/// Whether that is what the planner hoped for: the object was found, or no look was needed.
bool went_well(const Json& task);

/// Asks for the task again and again until it has ended; tasks survive a restart of the daemon, so
/// silence of up to half a minute is waited for. Errors: the daemon refuses, is silent for longer,
/// or it is asked to stop.
Result<Answer> wait_for_end(Answer task, const TaskWaitSeams& seams);

}  // namespace anchord
