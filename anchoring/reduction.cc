#include "anchoring/reduction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "models/kinematic.h"

namespace anchord {
namespace {

/// Squared distances within which hypotheses become one, tried in turn: from a fraction of a
/// standard deviation in one coordinate to about one and a half. Simulated crowds seldom need more.
constexpr double kClosest = 0.03, kFarthest = 3, kWider = 3;
/// What a whole unit of probability is worth as a squared distance: an object more or less is never
/// alike.
constexpr double kCertain = 100;
constexpr double kApart = std::numeric_limits<double>::infinity();

/// Between two normal densities of one coordinate: the symmetric Kullback-Leibler divergence, with
/// the gap in units of the mean variance.
double distance2(double gap, double variance_a, double variance_b) {
  const double sum = variance_a + variance_b, product = variance_a * variance_b;
  const double change = variance_a - variance_b;
  return (sum > 0 ? 2 * gap * gap / sum : 0) + (product > 0 ? change * change / (2 * product) : 0);
}

/// Of what is `most` or more, here and below, only that it is.
double distance2(const Kinematic& a, const Kinematic& b, double most, int dims) {
  double sum = 0;
  for (int i = 0; i < dims && sum < most; ++i)
    sum += distance2(a.position[i] - b.position[i], a.pp(i, i), b.pp(i, i));
  for (int i = 0; i < dims && sum < most; ++i)
    sum += distance2(a.velocity[i] - b.velocity[i], a.vv(i, i), b.vv(i, i));
  return sum;
}

/// Of two states of one behaviour model; kApart where they cannot be mixed.
double distance2(const ModelState& a, const ModelState& b, double most, int dims) {
  const double sum = kCertain / 2 * std::abs(a.weight - b.weight);
  const auto *ka = std::get_if<Kinematic>(&a.density), *kb = std::get_if<Kinematic>(&b.density);
  if (!ka != !kb) return kApart;
  if (ka) {
    const double weight = std::min(a.weight, b.weight);
    return weight > 0 ? sum + weight * distance2(*ka, *kb, (most - sum) / weight, dims) : sum;
  }
  const bool same_place =
      std::get<Somewhere>(a.density).footprint() == std::get<Somewhere>(b.density).footprint();
  return same_place ? sum : kApart;
}

double distance2(const AttributeBelief& a, const AttributeBelief& b) {
  if (a.attribute != b.attribute || a.symbols.size() != b.symbols.size()) return kApart;
  if (a.symbols.empty()) return distance2(a.mean - b.mean, a.variance, b.variance);
  double sum = 0;
  for (std::size_t s = 0; s < a.symbols.size(); ++s)
    sum += kCertain / 2 * std::abs(a.symbols[s] - b.symbols[s]);
  return sum;
}

/// Of two versions of an anchor; kApart where merge() cannot mix them.
double distance2(const Leaf& a, const Leaf& b, double most, int dims) {
  if (a.model_class != b.model_class || a.held != b.held || a.models.size() != b.models.size() ||
      a.attributes.size() != b.attributes.size())
    return kApart;
  double sum = kCertain * std::abs(a.existence - b.existence);
  for (std::size_t m = 0; m < a.models.size() && sum < most; ++m)
    sum += distance2(a.models[m], b.models[m], most - sum, dims);
  if (sum >= most) return sum;
  for (std::size_t c = 0; c < a.classes.size(); ++c)
    sum += kCertain / 2 * std::abs(a.classes[c] - b.classes[c]);
  for (std::size_t i = 0; i < a.attributes.size(); ++i)
    sum += distance2(a.attributes[i], b.attributes[i]);
  return sum;
}

/// Which hypotheses go into which.
class Groups {
 public:
  Groups(const Cluster& cluster, int dims)
      : cluster_(cluster),
        dims_(dims),
        into_(cluster.hypotheses.size()),
        heads_(cluster.hypotheses.size()) {
    std::iota(into_.begin(), into_.end(), 0);
    std::iota(heads_.begin(), heads_.end(), 0);
    for (const Hypothesis& h : cluster.hypotheses) leaves_.push_back(h.leaf);
  }

  std::size_t count() const { return heads_.size(); }

  /// Puts each that is nearer than `most` to a more probable one into the first such one.
  void widen(double most) {
    std::vector<int> stay;
    for (const int h : heads_) {
      const auto near = std::find_if(stay.begin(), stay.end(), [&](int head) {
        return squared(leaves_[h], leaves_[head], most) < most;
      });
      if (near == stay.end())
        stay.push_back(h);
      else
        put(h, *near);
    }
    heads_ = std::move(stay);
  }

  /// For each hypothesis the one that it ends in; that of those that stay is their own.
  std::vector<int> into() const {
    std::vector<int> out = into_;
    for (int& head : out) head = out[head];  // a head stands before all that go into it
    return out;
  }

 private:
  using Leaves = decltype(Hypothesis::leaf);

  double squared(const Leaves& g, const Leaves& h, double most) const {
    double sum = 0;
    for (std::size_t a = 0; a < g.size() && sum < most; ++a) {
      if (g[a] == h[a]) continue;
      const auto& leaves = cluster_.anchors[a].leaves;
      if (g[a] == Hypothesis::kNoLeaf || h[a] == Hypothesis::kNoLeaf)
        sum += kCertain * leaves[std::max(g[a], h[a])]->existence;
      else
        sum += distance2(*leaves[g[a]], *leaves[h[a]], most - sum, dims_);
    }
    return sum;
  }

  /// A head without a version of an anchor takes that of the first that has one, so that all that
  /// go into it are held against that.
  void put(int h, int head) {
    into_[h] = head;
    for (std::size_t a = 0; a < leaves_[h].size(); ++a)
      if (leaves_[head][a] == Hypothesis::kNoLeaf) leaves_[head][a] = leaves_[h][a];
  }

  const Cluster& cluster_;
  int dims_;
  std::vector<int> into_, heads_;
  std::vector<Leaves> leaves_;  // per hypothesis, of it and all that went into it
};

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

bool merge_nearest(Cluster& cluster, int max, const Background& background) {
  HypothesisSet& all = cluster.hypotheses;
  if (max <= 0 || all.size() <= static_cast<std::size_t>(max)) return false;
  Groups groups(cluster, background.dims);
  for (double most = kClosest; most <= kFarthest && groups.count() > static_cast<std::size_t>(max);
       most *= kWider)
    groups.widen(most);
  const std::vector<int> into = groups.into();
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
  const bool any = kept < all.size();
  all.resize(kept);
  normalise(all);
  return any;
}

}  // namespace anchord
