#include "perception/look_series.h"

namespace anchord {

std::optional<VerificationResult::Outcome> LookSeries::add(const Sighting& sighting) {
  using Outcome = VerificationResult::Outcome;
  if (sighting.sight == Sighting::Sight::kFound) return Outcome::kFound;
  absent_ = sighting.sight == Sighting::Sight::kAbsent ? absent_ + 1 : 0;
  hidden_ = sighting.sight == Sighting::Sight::kHidden ? hidden_ + 1 : 0;
  if (absent_ >= looks_) return Outcome::kMissing;
  if (hidden_ >= looks_) return Outcome::kOccluded;
  return std::nullopt;
}

}  // namespace anchord
