#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/result.h"

namespace anchord {

/// What `anchorctl export` and `anchorctl rebuild` are told.
struct LogCall {
  std::string directory;
  std::string from, to;      ///< export: "": from the log's beginning, to its end; see read_time()
  std::string output = "-";  ///< export: a file; LCM if its name ends in .lcm or .lcmlog
};

void add_log_commands(CLI::App& app, LogCall& call);

/// Writes a span of a log as anchor-replay reads it; gives a line about it, empty where the log
/// itself goes to standard output.
Result<std::string> export_span(const LogCall& call);

/// Folds a log anew; gives a line about it. Tells on standard error how far it is.
Result<std::string> rebuild_log(const LogCall& call);

}  // namespace anchord
