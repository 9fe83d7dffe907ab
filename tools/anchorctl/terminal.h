#pragma once

#include <string>

#include "tools/anchorctl/table.h"

namespace anchord {

/// Whether standard output is a terminal that can be redrawn.
bool on_terminal();

/// Of standard output now: a terminal's size, and colours unless NO_COLOR is set; if it is no
/// terminal, no colours and any width.
Style terminal_style();

/// While it lives, SIGINT and SIGTERM only set stopped().
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static bool stopped();
  /// Sleeps so long, or until stopped(): then false.
  static bool wait(double seconds);
};

/// Writes all of it to standard output at once; false if that cannot be done.
bool print(const std::string& text);

}  // namespace anchord
