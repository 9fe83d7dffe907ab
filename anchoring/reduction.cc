#include "anchoring/reduction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/scratch.h"

namespace anchord {
namespace {

/// How far apart hypotheses are that become one, tried in turn: the difference() of their versions,
/// summed over anchors. Below 1, so that what is not comparable is never made one.
constexpr double kClosest = 0.05, kFarthest = 0.8, kWider = 3;

/// Which hypotheses go into which.
class Groups {
 public:
  Groups(const Cluster& cluster, const Background& background)
      : cluster_(cluster),
        background_(background),
        into_(cluster.hypotheses.size()),
        heads_(cluster.hypotheses.size()) {
    std::iota(into_.begin(), into_.end(), 0);
    std::iota(heads_.begin(), heads_.end(), 0);
    for (const Hypothesis& h : cluster.hypotheses) leaves_.push_back(h.leaf);
    for (const AnchorTree& tree : cluster.anchors) {
      const std::size_t n = tree.leaves.size();
      known_.emplace_back(n <= kMostKept ? n * n : 0, kUnknown);
    }
  }

  std::size_t count() const { return heads_.size(); }

  /// Puts each that is nearer than `most` to a more probable one into the first such one.
  void widen(double most) {
    label(most);
    ScratchVector<int> stay;
    for (const int h : heads_) {
      const auto near = std::find_if(stay.begin(), stay.end(), [&](int head) {
        return labels_[h] == labels_[head] && apart(leaves_[h], leaves_[head], most) < most;
      });
      if (near == stay.end())
        stay.push_back(h);
      else
        put(h, *near);
    }
    heads_ = std::move(stay);
  }

  /// For each hypothesis the one that it ends in; that of those that stay is their own.
  ScratchVector<int> into() const {
    ScratchVector<int> out = into_;
    for (int& head : out) head = out[head];  // a head stands before all that go into it
    return out;
  }

 private:
  using Leaves = decltype(Hypothesis::leaf);
  static constexpr double kUnknown = -1;
  static constexpr std::size_t kMostKept = 512;  ///< versions of an anchor: 2 MB
  static constexpr int kMostLabelled = 64;       ///< of more, all pairs are too many

  /// Those whose labels differ are at least `most` apart: some anchor's versions are, even by steps
  /// over others. Most pairs are told apart so, without looking at each anchor.
  void label(double most) {
    labels_.assign(leaves_.size(), 0);
    ScratchVector<int> into;  // per version, and last for none: the first one near it
    for (std::size_t a = 0; a < cluster_.anchors.size(); ++a) {
      const auto& versions = cluster_.anchors[a].leaves;
      const int n = static_cast<int>(versions.size());
      if (n > kMostLabelled) continue;
      into.resize(n + 1);
      std::iota(into.begin(), into.end(), 0);
      const auto root = [&](int l) {
        while (into[l] != l) l = into[l] = into[into[l]];
        return l;
      };
      for (int l = 0; l < n; ++l) {
        if (versions[l]->existence < most) into[root(l)] = root(n);
        for (int m = 0; m < l; ++m)
          if (root(l) != root(m) && between(a, m, l) < most) into[root(l)] = root(m);
      }
      for (std::size_t h = 0; h < leaves_.size(); ++h) {
        const int l = leaves_[h][a];
        const int near = root(l == Hypothesis::kNoLeaf ? n : l);
        labels_[h] = (labels_[h] ^ static_cast<std::uint64_t>(near)) * 1099511628211u;  // FNV-1a
      }
    }
  }

  /// Of what is at least `most`, only that it is.
  double apart(const Leaves& g, const Leaves& h, double most) {
    double sum = 0;
    for (std::size_t a = 0; a < g.size() && sum < most; ++a) {
      if (g[a] == h[a]) continue;
      const auto [l, m] = std::minmax(g[a], h[a]);
      sum += l == Hypothesis::kNoLeaf ? cluster_.anchors[a].leaves[m]->existence : between(a, l, m);
    }
    return sum;
  }

  /// Of two versions of an anchor; kept, since many hypotheses have the same ones.
  double between(std::size_t anchor, int l, int m) {
    const auto& leaves = cluster_.anchors[anchor].leaves;
    const auto difference_of = [&] {
      return difference(*leaves[l], *leaves[m], background_, kFarthest);
    };
    if (known_[anchor].empty()) return difference_of();
    double& known = known_[anchor][l * leaves.size() + m];
    if (known == kUnknown) known = difference_of();
    return known;
  }

  /// A head without a version of an anchor takes that of the first that has one, so that all that
  /// go into it are held against that.
  void put(int h, int head) {
    into_[h] = head;
    for (std::size_t a = 0; a < leaves_[h].size(); ++a)
      if (leaves_[head][a] == Hypothesis::kNoLeaf) leaves_[head][a] = leaves_[h][a];
  }

  const Cluster& cluster_;
  const Background& background_;
  ScratchVector<int> into_, heads_;
  ScratchVector<Leaves> leaves_;                // per hypothesis, of it and all that went into it
  ScratchVector<std::uint64_t> labels_;         // per hypothesis: see label()
  ScratchVector<ScratchVector<double>> known_;  // per anchor: see between()
};

/// A version that is not there at all is one that exists with probability 0.
std::shared_ptr<const Leaf> mixed(double weight_a, const Leaf* a, double weight_b, const Leaf* b,
                                  const Background& background) {
  if (a && b) return make_pooled<const Leaf>(merge(weight_a, *a, weight_b, *b, background));
  auto out = make_pooled<Leaf>(a ? *a : *b);
  out->existence *= (a ? weight_a : weight_b) / (weight_a + weight_b);
  return out;
}

/// Gives the first hypothesis the moments of both, in leaves of its own.
class Merging {
 public:
  Merging(Cluster& cluster, const Background& background)
      : cluster_(cluster),
        background_(background),
        first_new_(cluster.anchors.size()),
        weight_(cluster.hypotheses.size()) {
    for (std::size_t a = 0; a < first_new_.size(); ++a)
      first_new_[a] = static_cast<int>(cluster.anchors[a].leaves.size());
    for (std::size_t h = 0; h < weight_.size(); ++h)
      weight_[h] = std::exp(cluster.hypotheses[h].log_weight);
  }

  void put(int from, int into) {
    Hypothesis& to = cluster_.hypotheses[into];
    for (std::size_t a = 0; a < to.leaf.size(); ++a) {
      auto& leaves = cluster_.anchors[a].leaves;
      const int l = cluster_.hypotheses[from].leaf[a], m = to.leaf[a];
      if (l == m) continue;
      const auto at = [&](int i) { return i == Hypothesis::kNoLeaf ? nullptr : leaves[i].get(); };
      auto both = mixed(weight_[into], at(m), weight_[from], at(l), background_);
      if (m >= first_new_[a]) {
        leaves[m] = std::move(both);
      } else {
        to.leaf[a] = static_cast<int>(leaves.size());
        leaves.push_back(std::move(both));
      }
    }
    weight_[into] += weight_[from];
    to.log_weight = std::log(weight_[into]);
  }

 private:
  Cluster& cluster_;
  const Background& background_;
  ScratchVector<int> first_new_;  // per anchor: leaves from here on are of one hypothesis alone
  ScratchVector<double> weight_;
};

}  // namespace

bool merge_nearest(Cluster& cluster, int max, const Background& background) {
  HypothesisSet& all = cluster.hypotheses;
  if (max <= 0 || all.size() <= static_cast<std::size_t>(max)) return false;
  const Scratch scratch;
  Groups groups(cluster, background);
  for (double most = kClosest; most <= kFarthest && groups.count() > static_cast<std::size_t>(max);
       most *= kWider)
    groups.widen(most);
  const ScratchVector<int> into = groups.into();
  // Of what was shown, the most probable hypothesis that has it.
  ScratchVector<std::size_t> shows(cluster.anchors.size(), all.size());
  for (std::size_t a = 0; a < shows.size(); ++a)
    if (const int shown = cluster.anchors[a].shown; shown != Hypothesis::kNoLeaf)
      shows[a] = std::find_if(all.begin(), all.end(),
                              [&](const Hypothesis& h) { return h.leaf[a] == shown; }) -
                 all.begin();

  Merging merging(cluster, background);
  for (std::size_t h = 0; h < all.size(); ++h)
    if (into[h] != static_cast<int>(h)) merging.put(static_cast<int>(h), into[h]);
  for (std::size_t a = 0; a < shows.size(); ++a)
    if (shows[a] < all.size()) cluster.anchors[a].shown = all[into[shows[a]]].leaf[a];

  std::size_t kept = 0;
  for (std::size_t h = 0; h < all.size(); ++h)
    if (into[h] == static_cast<int>(h)) {
      if (kept != h) all[kept] = std::move(all[h]);
      ++kept;
    }
  const bool any = kept < all.size();
  all.resize(kept);
  normalise(all);
  return any;
}

void forget_improbable(Cluster& cluster, const Background& background) {
  const Limits& limits = background.knowledge.limits;
  if (limits.scan_depth == 0 || limits.min_probability <= 0) return;
  bool any = false;
  for (std::size_t a = 0; a < cluster.anchors.size(); ++a) {
    AnchorTree& tree = cluster.anchors[a];
    if (!tree.anchor->name.empty() || !tree.anchor->alias.empty()) continue;
    double p = 0;
    bool seen_of_late = false, there = false;
    for (const Hypothesis& h : cluster.hypotheses) {
      if (h.leaf[a] == Hypothesis::kNoLeaf) continue;
      const Leaf& leaf = *tree.leaves[h.leaf[a]];
      there = true;
      seen_of_late = seen_of_late || !leaf.recent.empty();
      p += std::exp(h.log_weight) * leaf.existence;
    }
    if (!there || seen_of_late || p >= limits.min_probability) continue;
    for (Hypothesis& h : cluster.hypotheses) h.leaf[a] = Hypothesis::kNoLeaf;
    tree.shown = Hypothesis::kNoLeaf;
    any = true;
  }
  if (any) merge_equal(cluster.hypotheses);
}

}  // namespace anchord
