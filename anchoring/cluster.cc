#include "anchoring/cluster.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "anchoring/leading.h"
#include "core/scratch.h"
#include "mht/factors.h"

namespace anchord {
namespace {

/// Versions that differ by less are alike; what differs more is never merged, however rare: a far
/// one moves the moments by more than its probability.
constexpr double kAlike = 0.3;
/// What merging two alike versions may cost: moments are kept, so that what is lost is of second
/// order in their difference, times how rare the rarer one is.
constexpr double kNegligibleMerge = 1e-4;

/// What may be off the product of independent clusters where hypotheses are bounded anyway, and
/// where they are not.
constexpr double kNegligible = 1e-4, kUneven = 0.05, kRounding = 1e-12;

/// The leaves of an anchor, made fewer: for each old one the number of the one it is now part of.
ScratchVector<int> merged(AnchorTree& tree, const ScratchVector<double>& probability,
                          const Background& background) {
  const std::size_t n = tree.leaves.size();
  ScratchVector<int> order(n), number(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return probability[a] != probability[b] ? probability[a] > probability[b] : a < b;
  });
  struct Kept {
    int head;  // the most probable of those in it: what others are compared with
    double probability;
    std::shared_ptr<const Leaf> mixture;  // of several
  };
  ScratchVector<Kept> kept;
  for (int l : order) {
    const Leaf& leaf = *tree.leaves[l];
    const auto into = std::find_if(kept.begin(), kept.end(), [&](const Kept& k) {
      return alike(*tree.leaves[k.head], leaf, probability[l], background);
    });
    number[l] = static_cast<int>(into - kept.begin());
    if (into == kept.end()) {
      kept.push_back({l, probability[l], nullptr});
    } else if (probability[l] > 0) {
      const Leaf& so_far = into->mixture ? *into->mixture : *tree.leaves[into->head];
      into->mixture = make_pooled<const Leaf>(
          merge(into->probability, so_far, probability[l], leaf, background));
      into->probability += probability[l];
    }
  }
  PoolVector<std::shared_ptr<const Leaf>> leaves;
  leaves.reserve(kept.size());
  for (Kept& k : kept)
    leaves.push_back(k.mixture ? std::move(k.mixture) : std::move(tree.leaves[k.head]));
  tree.leaves = std::move(leaves);
  return number;
}

}  // namespace

bool alike(const Leaf& a, const Leaf& b, double rarer, const Background& background) {
  const double rare = std::sqrt(kNegligibleMerge / rarer);
  const double most = rare < kAlike && a.recent != b.recent ? rare : kAlike;
  return difference(a, b, background, most) < most;
}

double Cluster::existence(int anchor, const Background& background) const {
  double p = 0;
  for (const Hypothesis& h : hypotheses)
    if (h.leaf[anchor] != Hypothesis::kNoLeaf)
      p += std::exp(h.log_weight) *
           real_existence(*anchors[anchor].leaves[h.leaf[anchor]], background);
  return p;
}

const Leaf* Cluster::best_leaf(int anchor) const {
  const int leaf = hypotheses[leading].leaf[anchor];
  return leaf == Hypothesis::kNoLeaf ? nullptr : anchors[anchor].leaves[leaf].get();
}

void merge_alike(Cluster& cluster, const Background& background) {
  const auto has_versions = [](const AnchorTree& tree) { return tree.leaves.size() > 1; };
  if (std::none_of(cluster.anchors.begin(), cluster.anchors.end(), has_versions)) return;
  const Scratch scratch;
  ScratchVector<double> weight(cluster.hypotheses.size());
  std::transform(cluster.hypotheses.begin(), cluster.hypotheses.end(), weight.begin(),
                 [](const Hypothesis& h) { return std::exp(h.log_weight); });
  bool any = false;
  for (std::size_t a = 0; a < cluster.anchors.size(); ++a) {
    AnchorTree& tree = cluster.anchors[a];
    if (!has_versions(tree)) continue;
    ScratchVector<double> probability(tree.leaves.size(), 0.0);
    for (std::size_t h = 0; h < weight.size(); ++h)
      if (const int leaf = cluster.hypotheses[h].leaf[a]; leaf != Hypothesis::kNoLeaf)
        probability[leaf] += weight[h];
    const std::size_t before = tree.leaves.size();
    const ScratchVector<int> number = merged(tree, probability, background);
    any = any || tree.leaves.size() < before;
    for (Hypothesis& h : cluster.hypotheses)
      if (h.leaf[a] != Hypothesis::kNoLeaf) h.leaf[a] = number[h.leaf[a]];
    if (tree.shown != Hypothesis::kNoLeaf) tree.shown = number[tree.shown];
  }
  if (any) merge_equal(cluster.hypotheses);
}

PoolVector<std::shared_ptr<const Cluster>> split(Cluster cluster, const Background& background,
                                                 double least) {
  const Limits& limits = background.knowledge.limits;
  const bool bounded = limits.min_weight > 0 || limits.max_hypotheses > 0;
  const bool full = limits.max_hypotheses > 0 &&
                    cluster.hypotheses.size() >= static_cast<std::size_t>(limits.max_hypotheses);
  const double last = full ? std::exp(cluster.hypotheses.back().log_weight) : 0;
  const double floor = std::max({limits.min_weight, least, last});
  const Cut cut = bounded ? Cut{floor, kNegligible, kUneven} : Cut{0, kRounding, 0};
  const Scratch scratch;
  PoolVector<std::shared_ptr<const Cluster>> parts;
  for (Factor& factor : factorise(std::move(cluster.hypotheses), cut)) {
    auto part = make_pooled<Cluster>();
    part->anchors.reserve(factor.anchors.size());
    ScratchVector<int> used;
    for (std::size_t i = 0; i < factor.anchors.size(); ++i) {
      AnchorTree& whole = cluster.anchors[factor.anchors[i]];
      ScratchVector<int> number(whole.leaves.size(), Hypothesis::kNoLeaf);
      AnchorTree tree{std::move(whole.anchor), {}};
      tree.leaves.reserve(whole.leaves.size());
      for (Hypothesis& h : factor.hypotheses) {
        int& leaf = h.leaf[i];
        if (leaf == Hypothesis::kNoLeaf) continue;
        if (number[leaf] == Hypothesis::kNoLeaf) {
          number[leaf] = static_cast<int>(tree.leaves.size());
          tree.leaves.push_back(std::move(whole.leaves[leaf]));
        }
        leaf = number[leaf];
      }
      if (tree.leaves.empty()) continue;
      if (whole.shown != Hypothesis::kNoLeaf) tree.shown = number[whole.shown];
      used.push_back(static_cast<int>(i));
      part->anchors.push_back(std::move(tree));
    }
    if (used.empty()) continue;
    part->hypotheses = used.size() == factor.anchors.size() ? std::move(factor.hypotheses)
                                                            : marginal(factor.hypotheses, used);
    choose_leading(*part, background);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace anchord
