#include "anchoring/cluster.h"

#include <cmath>
#include <map>

#include "mht/factors.h"

namespace anchord {
namespace {

/// Leaves whose means lie within this many standard deviations of each other are alike. A mixture
/// of two unit normals 0.5 apart differs from its moments' normal by a total variation of 0.001.
constexpr double kAlikeDistance = 0.5;
/// A dependence between anchors that changes no probability by more than this is let go where
/// hypotheses are bounded anyway; where they are not, only rounding is.
const double kNegligible = getenv("SP") ? atof(getenv("SP")) : 1e-4, kRounding = 1e-12;

/// What of a hypothesis the last scans tell: which anchor was given which detections.
std::vector<std::uint64_t> recent_history(const Cluster& cluster, const Hypothesis& h) {
  std::vector<std::uint64_t> history;
  for (std::size_t a = 0; a < h.leaf.size(); ++a) {
    if (h.leaf[a] == Hypothesis::kNoLeaf) continue;
    const auto& recent = cluster.anchors[a].leaves[h.leaf[a]]->recent;
    if (recent.empty()) continue;
    history.push_back(~static_cast<std::uint64_t>(a));  // no detection has so high a number
    history.insert(history.end(), recent.begin(), recent.end());
  }
  return history;
}

bool alike(const Cluster& cluster, const Hypothesis& x, const Hypothesis& y,
           const Background& background) {
  for (std::size_t a = 0; a < x.leaf.size(); ++a) {
    if (x.leaf[a] == y.leaf[a] || x.leaf[a] == Hypothesis::kNoLeaf ||
        y.leaf[a] == Hypothesis::kNoLeaf)
      continue;
    const auto& leaves = cluster.anchors[a].leaves;
    if (!alike(*leaves[x.leaf[a]], *leaves[y.leaf[a]], kAlikeDistance, background)) return false;
  }
  return true;
}

/// An anchor's leaf for two hypotheses made one. Where one of them has none, existence falls.
int merged_leaf(AnchorTree& tree, double weight_x, int x, double weight_y, int y,
                const Background& background) {
  if (x == y) return x;
  if (x == Hypothesis::kNoLeaf || y == Hypothesis::kNoLeaf) {
    const bool has_x = x != Hypothesis::kNoLeaf;
    Leaf leaf = *tree.leaves[has_x ? x : y];
    leaf.existence *= (has_x ? weight_x : weight_y) / (weight_x + weight_y);
    if (leaf.existence < background.knowledge.limits.min_existence) return Hypothesis::kNoLeaf;
    tree.leaves.push_back(std::make_shared<const Leaf>(std::move(leaf)));
  } else {
    tree.leaves.push_back(std::make_shared<const Leaf>(
        merge(weight_x, *tree.leaves[x], weight_y, *tree.leaves[y], background)));
  }
  return static_cast<int>(tree.leaves.size()) - 1;
}

}  // namespace

double Cluster::existence(int anchor) const {
  double p = 0;
  for (const Hypothesis& h : hypotheses)
    if (h.leaf[anchor] != Hypothesis::kNoLeaf)
      p += std::exp(h.log_weight) * anchors[anchor].leaves[h.leaf[anchor]]->existence;
  return p;
}

const Leaf* Cluster::best_leaf(int anchor) const {
  const int leaf = hypotheses.front().leaf[anchor];
  return leaf == Hypothesis::kNoLeaf ? nullptr : anchors[anchor].leaves[leaf].get();
}

void merge_alike(Cluster& cluster, const Background& background) {
  if (cluster.hypotheses.size() < 2) return;
  std::map<std::vector<std::uint64_t>, std::vector<std::size_t>> groups;
  HypothesisSet kept;
  bool merged = false;
  for (Hypothesis& h : cluster.hypotheses) {
    auto& group = groups[recent_history(cluster, h)];
    Hypothesis* into = nullptr;
    for (std::size_t i : group)
      if (alike(cluster, kept[i], h, background)) {
        into = &kept[i];
        break;
      }
    if (!into) {
      group.push_back(kept.size());
      kept.push_back(std::move(h));
      continue;
    }
    const double x = std::exp(into->log_weight), y = std::exp(h.log_weight);
    for (std::size_t a = 0; a < h.leaf.size(); ++a)
      into->leaf[a] =
          merged_leaf(cluster.anchors[a], x, into->leaf[a], y, h.leaf[a], background);
    into->log_weight = std::log(x + y);
    merged = true;
  }
  cluster.hypotheses = std::move(kept);
  if (merged) normalise(cluster.hypotheses);
}

std::vector<std::shared_ptr<const Cluster>> split(const Cluster& cluster,
                                                  const Background& background) {
  const Limits& limits = background.knowledge.limits;
  const bool cut = limits.max_hypotheses > 0 &&
                   cluster.hypotheses.size() >= static_cast<std::size_t>(limits.max_hypotheses);
  const double floor = cut ? std::exp(cluster.hypotheses.back().log_weight) : limits.min_weight;
  const double tolerance =
      limits.min_weight > 0 || limits.max_hypotheses > 0 ? kNegligible : kRounding;
  std::vector<std::shared_ptr<const Cluster>> parts;
  for (Factor& factor : factorise(cluster.hypotheses, floor, tolerance)) {
    auto part = std::make_shared<Cluster>();
    std::vector<int> used;
    for (std::size_t i = 0; i < factor.anchors.size(); ++i) {
      const auto& leaves = cluster.anchors[factor.anchors[i]].leaves;
      std::vector<int> number(leaves.size(), Hypothesis::kNoLeaf);
      AnchorTree tree{cluster.anchors[factor.anchors[i]].anchor, {}};
      for (Hypothesis& h : factor.hypotheses) {
        int& leaf = h.leaf[i];
        if (leaf == Hypothesis::kNoLeaf) continue;
        if (number[leaf] == Hypothesis::kNoLeaf) {
          number[leaf] = static_cast<int>(tree.leaves.size());
          tree.leaves.push_back(leaves[leaf]);
        }
        leaf = number[leaf];
      }
      if (tree.leaves.empty()) continue;
      used.push_back(static_cast<int>(i));
      part->anchors.push_back(std::move(tree));
    }
    if (used.empty()) continue;
    part->hypotheses = used.size() == factor.anchors.size() ? std::move(factor.hypotheses)
                                                            : marginal(factor.hypotheses, used);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace anchord
