#pragma once

#include <cstdlib>

/// Ends a fuzz target's run with a finding.
inline void require(bool holds) {
  if (!holds) std::abort();
}
