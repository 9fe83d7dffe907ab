#include "anchoring/tied.h"

#include <algorithm>

namespace anchord {

Tied tie(const ScratchVector<PredictedCluster>& clusters, const Limits& limits,
         std::optional<std::size_t> most) {
  Tied tied;
  for (const PredictedCluster& c : clusters) {
    for (std::size_t a = 0; a < c.leaves.size(); ++a) {
      tied.first_leaf.push_back(static_cast<int>(tied.leaves.size()));
      tied.anchors.push_back(c.cluster->anchors[a].anchor);
      for (const PredictedLeaf& leaf : c.leaves[a]) tied.leaves.push_back(&leaf);
    }
    if (&c == &clusters.front())
      tied.refer_to(c.cluster->hypotheses);
    else
      tied.keep(join(tied.hypotheses(), c.cluster->hypotheses, limits.max_hypotheses,
                     limits.min_weight, &tied.dropped));
  }
  if (clusters.empty()) tied.keep({{0.0, {}}});
  if (most && tied.hypotheses().size() > *most) {
    HypothesisSet best(tied.hypotheses());
    tied.cut = true;
    tied.dropped += prune(best, static_cast<int>(*most), 0);
    tied.keep(std::move(best));
  }
  const auto was_shown = [&](const Hypothesis& h) {
    std::size_t at = 0;
    for (const PredictedCluster& c : clusters)
      for (const int leaf : c.cluster->hypotheses[c.cluster->leading].leaf)
        if (h.leaf[at++] != leaf) return false;
    return true;
  };
  const HypothesisSet& all = tied.hypotheses();
  const auto shown = std::find_if(all.begin(), all.end(), was_shown);
  tied.leading = shown == all.end() ? -1 : static_cast<int>(shown - all.begin());
  return tied;
}

AssociationProblem problem_of(const Tied& tied, const ScratchVector<int>& detections) {
  AssociationProblem problem;
  problem.detections = static_cast<int>(detections.size());
  problem.gains.reserve(tied.leaves.size());
  for (const PredictedLeaf* leaf : tied.leaves) {
    auto& gains = problem.gains.emplace_back();
    for (const auto& [z, log_gain] : leaf->gains) {
      const auto at = std::lower_bound(detections.begin(), detections.end(), z);
      if (at != detections.end() && *at == z)
        gains.push_back({static_cast<int>(at - detections.begin()), log_gain});
    }
  }
  problem.parents.reserve(tied.hypotheses().size());
  for (const Hypothesis& h : tied.hypotheses()) {
    AssociationProblem::Parent& parent = problem.parents.emplace_back();
    parent.log_weight = h.log_weight;
    parent.leaves.reserve(h.leaf.size());
    for (std::size_t a = 0; a < h.leaf.size(); ++a) {
      if (h.leaf[a] == Hypothesis::kNoLeaf) continue;
      const int leaf = tied.first_leaf[a] + h.leaf[a];
      parent.leaves.push_back(leaf);
      parent.log_weight += tied.leaves[leaf]->log_miss;
    }
  }
  return problem;
}

}  // namespace anchord
