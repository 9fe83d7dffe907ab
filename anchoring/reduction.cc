#include "anchoring/reduction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "anchoring/reading.h"

namespace anchord {
namespace {

/// Squared distances within which hypotheses become one, tried in turn: from a fraction of a
/// standard deviation in one coordinate to a few in several. Chosen on simulated crowds.
constexpr double kClosest = 0.03, kFarthest = 30, kWider = 3;
/// What a whole unit of probability is worth as a squared distance: an object more or less is never
/// alike.
constexpr double kCertain = 100;
constexpr double kApart = std::numeric_limits<double>::infinity();

double differing(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += 0.5 * std::abs(a[i] - b[i]);
  return sum;
}

/// Squared distance of two versions of an anchor in what is not position: kCertain times the
/// probability by which they differ.
double other_distance2(const Leaf& a, const Leaf& b) {
  if (a.model_class != b.model_class || a.held != b.held || a.models.size() != b.models.size() ||
      a.attributes.size() != b.attributes.size())
    return kApart;
  double probability = std::abs(a.existence - b.existence), scalar = 0;
  for (std::size_t m = 0; m < a.models.size(); ++m)
    probability += 0.5 * std::abs(a.models[m].weight - b.models[m].weight);
  for (std::size_t c = 0; c < a.classes.size(); ++c)
    probability += 0.5 * std::abs(a.classes[c] - b.classes[c]);
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    const AttributeBelief &x = a.attributes[i], &y = b.attributes[i];
    if (x.attribute != y.attribute) return kApart;
    probability += differing(x.symbols, y.symbols);
    if (x.symbols.empty())
      scalar += (x.mean - y.mean) * (x.mean - y.mean) / std::sqrt(x.variance * y.variance);
  }
  return kCertain * probability + scalar;
}

/// Squared distances between hypotheses.
class Distances {
 public:
  Distances(const Cluster& cluster, int dims) : cluster_(cluster), dims_(dims) {
    for (const AnchorTree& tree : cluster.anchors) {
      auto& scaled = scaled_.emplace_back();
      for (const auto& leaf : tree.leaves) scaled.push_back(in_deviations(*leaf));
    }
  }

  /// Of what `most` or more it is, only that it is.
  double squared(const Hypothesis& g, const Hypothesis& h, double most) const {
    double sum = 0;
    for (std::size_t a = 0; a < g.leaf.size() && sum < most; ++a) {
      const int l = g.leaf[a], m = h.leaf[a];
      if (l == m) continue;
      const auto& leaves = cluster_.anchors[a].leaves;
      if (l == Hypothesis::kNoLeaf || m == Hypothesis::kNoLeaf) {
        sum += kCertain * leaves[std::max(l, m)]->existence;
        continue;
      }
      for (int i = 0; i < 2 * dims_; ++i) {
        const double gap = scaled_[a][l][i] - scaled_[a][m][i];
        sum += gap * gap;
      }
      if (sum < most) sum += other_distance2(*leaves[l], *leaves[m]);
    }
    return sum;
  }

 private:
  /// Position and velocity, each in its own standard deviations.
  std::array<double, 6> in_deviations(const Leaf& leaf) const {
    const Kinematic& k = position_of(leaf);
    const auto scaled = [](double x, double variance) {
      return variance > 0 ? x / std::sqrt(variance) : x;
    };
    std::array<double, 6> out{};
    for (int i = 0; i < dims_; ++i) {
      out[i] = scaled(k.position[i], k.pp(i, i));
      out[dims_ + i] = scaled(k.velocity[i], k.vv(i, i));
    }
    return out;
  }

  const Cluster& cluster_;
  int dims_;
  std::vector<std::vector<std::array<double, 6>>> scaled_;  // per anchor and leaf
};

/// For each hypothesis the one that it goes into; that of those that stay is their own.
std::vector<int> groups(const Cluster& cluster, int max, int dims) {
  const HypothesisSet& all = cluster.hypotheses;
  const Distances distances(cluster, dims);
  std::vector<int> into(all.size()), heads(all.size());
  std::iota(into.begin(), into.end(), 0);
  std::iota(heads.begin(), heads.end(), 0);
  for (double most = kClosest; most <= kFarthest && heads.size() > static_cast<std::size_t>(max);
       most *= kWider) {
    std::vector<int> stay;
    for (const int h : heads) {
      const auto near = std::find_if(stay.begin(), stay.end(), [&](int head) {
        return distances.squared(all[h], all[head], most) < most;
      });
      if (near == stay.end())
        stay.push_back(h);
      else
        into[h] = *near;
    }
    heads = std::move(stay);
  }
  for (std::size_t h = 0; h < into.size(); ++h) into[h] = into[into[h]];  // heads come first
  return into;
}

/// A version that is not there at all is one that exists with probability 0.
std::shared_ptr<const Leaf> mixed(double weight_a, const Leaf* a, double weight_b, const Leaf* b,
                                  const Background& background) {
  if (a && b) return std::make_shared<const Leaf>(merge(weight_a, *a, weight_b, *b, background));
  auto out = std::make_shared<Leaf>(a ? *a : *b);
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
  std::vector<int> first_new_;  // per anchor: leaves from here on are of one hypothesis alone
  std::vector<double> weight_;
};

}  // namespace

void merge_nearest(Cluster& cluster, int max, const Background& background) {
  HypothesisSet& all = cluster.hypotheses;
  if (max <= 0 || all.size() <= static_cast<std::size_t>(max)) return;
  const std::vector<int> into = groups(cluster, max, background.dims);
  // Of what was shown, the most probable hypothesis that has it.
  std::vector<std::size_t> shows(cluster.anchors.size(), all.size());
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
  all.resize(kept);
  normalise(all);
}

}  // namespace anchord
