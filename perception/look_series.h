#pragma once

#include <optional>

#include "core/verification.h"
#include "perception/sighting.h"

namespace anchord {

/// What the looks of one task come to. A single miss means little (thesis section 3.7.3): found
/// counts at once, missing and occluded only after a number of looks in a row say so; a doubtful
/// look, and one elsewhere, breaks the row.
class LookSeries {
 public:
  /// `looks` >= 1: in a row.
  explicit LookSeries(int looks) : looks_(looks) {}

  /// Takes the next look; the task's outcome once it is decided.
  std::optional<VerificationResult::Outcome> add(const Sighting& sighting);

 private:
  int looks_;
  int absent_ = 0, hidden_ = 0;
};

}  // namespace anchord
