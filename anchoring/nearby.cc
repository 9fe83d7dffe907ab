#include "anchoring/nearby.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace anchord {

Nearby::Nearby(const MapFrame& frame, const Background& background)
    : background_(background), all_(frame.detections.size()) {
  std::iota(all_.begin(), all_.end(), 0);
  for (const int z : all_) {
    const MapDetection& detection = frame.detections[z];
    by_x_.push_back({detection.position.mean.x(), z});
    if (!detection.object.empty()) naming_.push_back(z);
    widest_ = std::max(widest_, detection.position.covariance.trace());
  }
  std::sort(by_x_.begin(), by_x_.end());
}

const ScratchVector<int>& Nearby::to(const Leaf& leaf) {
  const double gate = background_.knowledge.limits.gate_probability;
  if (gate >= 1) return all_;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ModelState& state : leaf.models) {
    if (!(state.weight > 1 - gate)) continue;
    const auto* kinematic = std::get_if<Kinematic>(&state.density);
    if (!kinematic) return all_;
    const double trace = kinematic->pp.trace() + widest_;
    const double reach = std::sqrt(background_.gate_distance2 * trace);
    low = std::min(low, kinematic->position.x() - reach);
    high = std::max(high, kinematic->position.x() + reach);
  }
  found_ = naming_;
  for (auto at = std::lower_bound(by_x_.begin(), by_x_.end(), std::pair(low, 0));
       at != by_x_.end() && at->first <= high; ++at)
    found_.push_back(at->second);
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  return found_;
}

}  // namespace anchord
