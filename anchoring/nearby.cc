#include "anchoring/nearby.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anchord {

Nearby::Nearby(const MapFrame& frame, const Background& background)
    : background_(background), all_(frame.detections.size()) {
  std::iota(all_.begin(), all_.end(), 0);
  for (const int z : all_) {
    const MapDetection& detection = frame.detections[z];
    by_x_.push_back({detection.position.mean.x(), z});
    if (!detection.object.empty()) naming_.push_back(z);
    widest_ = std::max(widest_, detection.position.covariance(0, 0));
  }
  std::sort(by_x_.begin(), by_x_.end());
}

const ScratchVector<int>& Nearby::to(const Leaf& leaf) {
  const double gate = background_.knowledge.limits.gate_probability;
  if (gate >= 1) return all_;
  found_ = naming_;
  const auto take = [&](double low, double high, double variance) {
    const double reach = std::sqrt(background_.gate_distance2 * (variance + widest_));
    for (auto at = std::lower_bound(by_x_.begin(), by_x_.end(), std::pair(low - reach, 0));
         at != by_x_.end() && at->first <= high + reach; ++at)
      found_.push_back(at->second);
  };
  for (const ModelState& state : leaf.models) {
    if (!(state.weight > 1 - gate)) continue;
    if (const auto* kinematic = std::get_if<Kinematic>(&state.density)) {
      take(kinematic->position.x(), kinematic->position.x(), kinematic->pp(0, 0));
    } else {
      // Of a detection further than its gate from a place less lies there than a gate leaves out.
      const Grid& grid = std::get<Somewhere>(state.density).footprint()->grid;
      take(grid.corner_min(0).x(), grid.corner_max(grid.size() - 1).x(), 0);
    }
  }
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  return found_;
}

}  // namespace anchord
