#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/result.h"

namespace anchord {

struct RebuildReport {
  std::int64_t folded = 0;       ///< frames and events
  std::int64_t first = 1;        ///< the first of them
  std::int64_t checkpoints = 0;  ///< bytes of what was written
};

/// Folds the log in `directory` anew from what it holds, each frame under the configuration that
/// was in force, and makes checkpoints and histories again: for a program that believes otherwise
/// than the one that made them. `progress` is told how many are done, of how many. Of a log whose
/// beginning was given up, what that was folded into stays, and histories from before it.
/// kUnavailable: a process holds the log; kUnknown: there is none.
Result<RebuildReport> rebuild(const std::string& directory,
                              const std::function<void(std::int64_t, std::int64_t)>& progress);

}  // namespace anchord
