#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "core/result.h"
#include "tools/anchorctl/http_client.h"
#include "tools/anchorctl/query.h"

namespace anchord {

/// The options of `anchorctl verify`, beside the words that say which object is meant.
struct VerifyOptions {
  std::string action, sensor, robot;
  std::optional<double> timeout_s;
  bool alone = false;
  bool wait = false;  ///< until the task has ended
  bool all = false;   ///< list those that have ended, too
  std::optional<std::int64_t> cancel;
};

void add_options(CLI::App& command, VerifyOptions& options);

/// Without words the list of tasks, with `cancel` the end of one, with words a trigger. Refused:
/// options that do not go together, with the one that is too much.
Result<HttpCall> verify_call(const VerifyOptions& options, const Parameters& words);

}  // namespace anchord
