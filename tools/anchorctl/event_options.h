#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "tools/anchorctl/fields.h"

namespace anchord {

/// What the commands name, join, drop, undo and event take.
struct EventOptions {
  std::string kind;           ///< event: grasped, placed, moved, removed
  std::string object, other;  ///< name: the alias is the other
  std::string place, robot;
  std::vector<double> at;  ///< 2 or 3 numbers, m; empty: not told
  std::int64_t number = 0;
};

/// Adds the five commands, and to each what `common` adds.
void add_event_commands(CLI::App& app, EventOptions& options,
                        const std::function<void(CLI::App&)>& common);

/// Whether `command` is one of them.
bool is_event_command(const std::string& command);

/// The event that `command` tells, without its utime. Refused: what its kind has no use for.
Result<Json> event_body(const std::string& command, const EventOptions& options);

}  // namespace anchord
