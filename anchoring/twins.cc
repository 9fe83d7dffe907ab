#include "anchoring/twins.h"

#include <algorithm>
#include <cmath>

#include "anchoring/cluster.h"
#include "anchoring/leading.h"
#include "core/scratch.h"

namespace anchord {
namespace {

/// An anchor that is in all worlds but those of less probability, or in none but those, has no
/// twin.
constexpr double kRare = 1e-3;
/// So many detections in common, the last ones, and versions that are alike: what was before that
/// tells nothing more.
constexpr std::size_t kLate = 5;

/// Whether two versions were given the same detections last.
bool same_of_late(const Leaf& a, const Leaf& b) {
  const std::size_t count = std::min({kLate, std::max(a.recent.size(), b.recent.size())});
  return a.recent.size() >= count && b.recent.size() >= count &&
         std::equal(a.recent.end() - static_cast<std::ptrdiff_t>(count), a.recent.end(),
                    b.recent.end() - static_cast<std::ptrdiff_t>(count));
}

class Twins {
 public:
  Twins(Cluster& cluster, const Background& background)
      : cluster_(cluster), background_(background) {
    for (const Hypothesis& h : cluster.hypotheses) weight_.push_back(std::exp(h.log_weight));
  }

  /// Anchors that may leave one name for another, or take it.
  ScratchVector<int> candidates() const {
    ScratchVector<int> out;
    for (std::size_t a = 0; a < cluster_.anchors.size(); ++a) {
      double present = 0;
      for (std::size_t h = 0; h < weight_.size(); ++h)
        if (cluster_.hypotheses[h].leaf[a] != Hypothesis::kNoLeaf) present += weight_[h];
      const Anchor& anchor = *cluster_.anchors[a].anchor;
      if (present > kRare && present < 1 - kRare && anchor.alias.empty() && !anchor.holder)
        out.push_back(static_cast<int>(a));
    }
    return out;
  }

  /// Whether any of their versions were given the same detections last.
  bool may_be_one(int a, int b) const {
    const auto& others = cluster_.anchors[b].leaves;
    const auto has_twin = [&](const auto& leaf) {
      return std::any_of(others.begin(), others.end(),
                         [&](const auto& other) { return same_of_late(*leaf, *other); });
    };
    const auto& leaves = cluster_.anchors[a].leaves;
    return std::any_of(leaves.begin(), leaves.end(), has_twin);
  }

  /// How much there is to be said for an anchor's name.
  double claim(int a) const {
    const AnchorTree& tree = cluster_.anchors[a];
    const bool shown = tree.shown != Hypothesis::kNoLeaf &&
                       real_existence(*tree.leaves[tree.shown], background_) >= kBelievedIn;
    return cluster_.existence(a, background_) * (shown ? kClearlyOther : 1);
  }

  /// In worlds without `into`: versions of `from` go by its name where it has one that is alike.
  bool join(int into, int from) {
    AnchorTree &to = cluster_.anchors[into], &other = cluster_.anchors[from];
    ScratchVector<double> moving(other.leaves.size(), 0.0), kept(to.leaves.size(), 0.0);
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      const auto& leaf = cluster_.hypotheses[i].leaf;
      if (leaf[into] != Hypothesis::kNoLeaf)
        kept[leaf[into]] += weight_[i];
      else if (leaf[from] != Hypothesis::kNoLeaf)
        moving[leaf[from]] += weight_[i];
    }
    ScratchVector<int> becomes(other.leaves.size(), Hypothesis::kNoLeaf);
    bool any = false;
    for (std::size_t l = 0; l < moving.size(); ++l) {
      if (moving[l] <= 0) continue;
      for (std::size_t k = 0; k < kept.size() && becomes[l] == Hypothesis::kNoLeaf; ++k)
        if (kept[k] > 0 && same_of_late(*to.leaves[k], *other.leaves[l]) &&
            alike(*to.leaves[k], *other.leaves[l], std::min(kept[k], moving[l]), background_))
          becomes[l] = static_cast<int>(k);
      const int k = becomes[l];
      if (k == Hypothesis::kNoLeaf) continue;
      to.leaves[k] = make_pooled<const Leaf>(
          merge(kept[k], *to.leaves[k], moving[l], *other.leaves[l], background_));
      kept[k] += moving[l];
      any = true;
    }
    if (!any) return false;
    if (other.shown != Hypothesis::kNoLeaf && to.shown == Hypothesis::kNoLeaf &&
        becomes[other.shown] != Hypothesis::kNoLeaf) {
      to.shown = becomes[other.shown];
      other.shown = Hypothesis::kNoLeaf;
    }
    for (Hypothesis& h : cluster_.hypotheses) {
      if (h.leaf[into] != Hypothesis::kNoLeaf || h.leaf[from] == Hypothesis::kNoLeaf) continue;
      if (becomes[h.leaf[from]] == Hypothesis::kNoLeaf) continue;
      h.leaf[into] = becomes[h.leaf[from]];
      h.leaf[from] = Hypothesis::kNoLeaf;
    }
    return true;
  }

 private:
  Cluster& cluster_;
  const Background& background_;
  ScratchVector<double> weight_;
};

}  // namespace

void join_twins(Cluster& cluster, const Background& background) {
  if (cluster.hypotheses.size() < 2) return;
  const Scratch scratch;
  Twins twins(cluster, background);
  const ScratchVector<int> candidates = twins.candidates();
  bool any = false;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t j = i + 1; j < candidates.size(); ++j) {
      const int older = candidates[i], newer = candidates[j];
      if (!twins.may_be_one(older, newer)) continue;
      const bool keep_older = twins.claim(older) >= twins.claim(newer);
      any = twins.join(keep_older ? older : newer, keep_older ? newer : older) || any;
    }
  if (any) merge_equal(cluster.hypotheses);
}

}  // namespace anchord
