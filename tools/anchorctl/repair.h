#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/result.h"
#include "knowledge/log_repair.h"

namespace anchord {

/// What `anchorctl repair` is told.
struct RepairCall {
  std::string directory;
  std::string until;  ///< "": all; see read_time()
  bool without_events = false, all_events = false;
};

void add_repair_command(CLI::App& app, RepairCall& call);

/// Repairs the log in a directory, and tells what became of it.
Result<std::string> repair(const RepairCall& call);

/// The report in words.
std::string repair_text(const RepairReport& report);

}  // namespace anchord
