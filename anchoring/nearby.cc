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
    const auto& [mean, covariance] = detection.position;
    by_x_.push_back({mean.x(), mean.y(), z});
    if (!detection.object.empty()) naming_.push_back(z);
    widest_x_ = std::max(widest_x_, covariance(0, 0));
    widest_y_ = std::max(widest_y_, covariance(1, 1));
  }
  std::sort(by_x_.begin(), by_x_.end(), [](const Place& a, const Place& b) { return a.x < b.x; });
}

/// What may gate with a density whose mean lies in a box and which has these variances.
void Nearby::take(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double variance_x,
                  double variance_y) {
  const double gate = background_.gate_distance2;
  const double reach_x = std::sqrt(gate * (variance_x + widest_x_));
  const double reach_y = std::sqrt(gate * (variance_y + widest_y_));
  for (auto at = std::lower_bound(by_x_.begin(), by_x_.end(), low.x() - reach_x,
                                  [](const Place&place, double x) { return place.x < x; });
       at != by_x_.end() && at->x <= high.x() + reach_x; ++at)
    if (at->y >= low.y() - reach_y && at->y <= high.y() + reach_y) found_.push_back(at->detection);
}

const ScratchVector<int>& Nearby::to(const Leaf& leaf) {
  const double gate = background_.knowledge.limits.gate_probability;
  if (gate >= 1) return all_;
  found_ = naming_;
  for (const ModelState& state : leaf.models) {
    if (!(state.weight > 1 - gate)) continue;
    if (const auto* kinematic = std::get_if<Kinematic>(&state.density)) {
      take(kinematic->position, kinematic->position, kinematic->pp(0, 0), kinematic->pp(1, 1));
    } else {
      // Of a detection further than its gate from a place less lies there than a gate leaves out.
      const Grid& grid = std::get<Somewhere>(state.density).footprint()->grid;
      take(grid.corner_min(0), grid.corner_max(grid.size() - 1), 0, 0);
    }
  }
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  return found_;
}

}  // namespace anchord
