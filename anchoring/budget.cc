#include "anchoring/budget.h"

#include <algorithm>

namespace anchord {
namespace {

/// Children that even a cluster of one hypothesis may have.
constexpr double kFewChildren = 10;

double need(double anchors, double hypotheses) { return anchors * (hypotheses + kFewChildren); }

}  // namespace

Budget::Budget(const ScratchVector<Group>& groups, std::optional<std::uint64_t> work,
               const Limits& limits)
    : left_(work) {
  if (!work) return;
  for (const Group& group : groups) {
    Need all{static_cast<double>(group.detections.size()), 1};  // each may be an anchor
    for (const PredictedCluster& c : group.clusters) {
      all.anchors += static_cast<double>(c.leaves.size());
      all.hypotheses *= static_cast<double>(c.cluster->hypotheses.size());
      if (limits.max_hypotheses > 0)
        all.hypotheses = std::min<double>(all.hypotheses, limits.max_hypotheses);
    }
    needed_ += need(all.anchors, all.hypotheses);
    needs_.push_back(all);
  }
}

Allowance Budget::next() {
  if (!left_) return {};
  const auto [anchors, hypotheses] = needs_[group_];
  const double share = need(anchors, hypotheses) / needed_;
  const double affordable = share * static_cast<double>(*left_) / anchors;
  // Of what there is, half at most for what was: else nothing could come of it.
  const double parents = std::max(1.0, std::min(hypotheses, affordable / 2));
  return {static_cast<std::size_t>(parents),
          static_cast<std::size_t>(std::max(1.0, affordable - parents))};
}

void Budget::take(std::uint64_t work) {
  if (!left_) return;
  *left_ -= std::min(*left_, work);
  needed_ -= need(needs_[group_].anchors, needs_[group_].hypotheses);
  ++group_;
}

}  // namespace anchord
