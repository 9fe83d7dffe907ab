#include "anchoring/coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "mht/marginals.h"

namespace anchord {
namespace {

/// A detection that comes from a cluster with at least this probability ties it in any case; with
/// less only where that is free: where clusters have more worlds together that are as probable than
/// may be kept, some of these would be lost for it. Chosen on simulated crowds, from 1e-4 to 0.3.
constexpr double kSure = 0.03;

/// Which clusters and detections belong together: numbers first the clusters, then the detections.
class Ties {
 public:
  explicit Ties(std::size_t n) : parent_(n), next_(n) {
    std::iota(parent_.begin(), parent_.end(), 0);
    std::iota(next_.begin(), next_.end(), 0);
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    std::swap(next_[a], next_[b]);
  }
  /// Calls a function with all that i belongs together with, i among them.
  template <typename Function>
  void with_all(std::size_t i, Function function) const {
    std::size_t member = i;
    do {
      function(member);
      member = next_[member];
    } while (member != i);
  }

 private:
  ScratchVector<std::size_t> parent_;
  ScratchVector<std::size_t> next_;  ///< a ring of those that belong together
};

/// That some leaf of an anchor is given a detection.
struct Edge {
  int cluster;
  Pairing pairing;  // the track is an anchor, numbered through
};

/// What each anchor is worth to each detection, whichever hypothesis holds, as if anchors were
/// independent of each other.
void add_edges(const PredictedCluster& predicted, int cluster, int& anchors,
               ScratchVector<Edge>& edges) {
  const HypothesisSet& hypotheses = predicted.cluster->hypotheses;
  ScratchVector<double> probability(hypotheses.size());
  std::transform(hypotheses.begin(), hypotheses.end(), probability.begin(),
                 [](const Hypothesis& h) { return std::exp(h.log_weight); });
  for (std::size_t a = 0; a < predicted.leaves.size(); ++a, ++anchors) {
    const auto& leaves = predicted.leaves[a];
    const auto has_gains = [](const PredictedLeaf& leaf) { return !leaf.gains.empty(); };
    if (std::none_of(leaves.begin(), leaves.end(), has_gains)) continue;
    ScratchVector<double> nothing(leaves.size(), 0.0);  // P(leaf), then: and it gives nothing
    double sum = 0;
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
      const int leaf = hypotheses[h].leaf[a];
      (leaf == Hypothesis::kNoLeaf ? sum : nothing[leaf]) += probability[h];
    }
    for (std::size_t l = 0; l < leaves.size(); ++l) {
      nothing[l] *= std::exp(leaves[l].log_miss);
      sum += nothing[l];
    }
    const std::size_t first = edges.size();
    for (std::size_t l = 0; l < leaves.size(); ++l)
      for (const auto& [z, log_gain] : leaves[l].gains) {
        const double weight = nothing[l] / sum * std::exp(std::min(log_gain, 500.0));
        const auto same = std::find_if(edges.begin() + first, edges.end(),
                                       [z = z](const Edge& e) { return e.pairing.detection == z; });
        if (same == edges.end())
          edges.push_back({cluster, {anchors, z, weight, 0}});
        else
          same->pairing.weight += weight;
      }
  }
}

/// How many hypotheses of a cluster weigh so much.
double worlds_above(const PredictedCluster& predicted, double log_weight) {
  const HypothesisSet& all = predicted.cluster->hypotheses;  // best first
  return static_cast<double>(
      std::partition_point(all.begin(), all.end(),
                           [&](const Hypothesis& h) { return h.log_weight >= log_weight; }) -
      all.begin());
}

/// Ties each cluster to the detections that may come from it: the surest first, as long as that
/// costs no worlds.
void tie_probable(const ScratchVector<PredictedCluster>& clusters, int detections,
                  const Limits& limits, Ties& ties) {
  ScratchVector<Edge> edges;
  int anchors = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c)
    add_edges(clusters[c], static_cast<int>(c), anchors, edges);
  ScratchVector<Pairing> pairings;
  for (const Edge& e : edges) pairings.push_back(e.pairing);
  estimate_probabilities(pairings, anchors, detections);
  count_exchanges(pairings, anchors, detections);
  ScratchVector<std::size_t> rare;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (pairings[e].probability >= kSure)
      ties.unite(edges[e].cluster, clusters.size() + pairings[e].detection);
    else if (pairings[e].probability >= limits.min_weight)
      rare.push_back(e);
  }
  std::sort(rare.begin(), rare.end(), [&](std::size_t a, std::size_t b) {
    const double pa = pairings[a].probability, pb = pairings[b].probability;
    return pa != pb ? pa > pb : a < b;
  });
  const double most =
      limits.max_hypotheses > 0 ? limits.max_hypotheses : std::numeric_limits<double>::infinity();
  for (const std::size_t e : rare) {
    const std::size_t c = edges[e].cluster, z = clusters.size() + pairings[e].detection;
    if (ties.find(c) == ties.find(z)) continue;
    const double log_tie = std::log(pairings[e].probability);
    double worlds = 1;  // that are worth as much as the tie
    const auto count = [&](std::size_t member) {
      if (member < clusters.size()) worlds *= worlds_above(clusters[member], log_tie);
    };
    ties.with_all(c, count);
    ties.with_all(z, count);
    if (worlds <= most) ties.unite(c, z);
  }
}

}  // namespace

ScratchVector<Group> couple(ScratchVector<PredictedCluster> clusters, int detections,
                            const Limits& limits) {
  const std::size_t n = clusters.size();
  Ties ties(n + detections);
  if (limits.min_weight <= 0) {
    for (std::size_t c = 0; c < n; ++c)
      for (int z = 0; z < detections; ++z)
        if (clusters[c].gated[z]) ties.unite(c, n + z);
  } else {
    tie_probable(clusters, detections, limits, ties);
  }
  ScratchVector<Group> by_root(n + detections);
  for (std::size_t c = 0; c < n; ++c)
    by_root[ties.find(c)].clusters.push_back(std::move(clusters[c]));
  for (int z = 0; z < detections; ++z) by_root[ties.find(n + z)].detections.push_back(z);
  ScratchVector<Group> groups;
  for (Group& group : by_root)
    if (!group.clusters.empty() || !group.detections.empty()) groups.push_back(std::move(group));
  return groups;
}

}  // namespace anchord
