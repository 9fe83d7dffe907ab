#include "mht/change_losses.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace anchord {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// That one takes what another has.
struct Change {
  int loser, taker;
  double slack;
  double* loss;
};

/// Who can lose to whom at what slack, detections and nobody, and the cheapest ways on.
class Ways {
 public:
  Ways(const ScratchVector<Change>& changes, const Assignment& best, double reach)
      : changes_(changes),
        reach_(reach),
        nobody_(best.detections()),
        distance_(nobody_ + 1, kInfinite),
        from_nobody_(nobody_ + 1, kInfinite) {
    for (const Change& change : changes) {
      while (static_cast<int>(first_.size()) <= change.taker) first_.push_back(first_at(change));
    }
    while (static_cast<int>(first_.size()) <= nobody_) first_.push_back(changes.size());
    from_nobody_[nobody_] = 0;
    for (int z = 0; z < nobody_; ++z)
      if (const double price = best.price_of_choice(z); price <= reach_) {
        from_nobody_[z] = price;
        reached_.push_back(z);
      }
    run(from_nobody_);
    reached_.clear();
  }

  /// The cheapest ways from `source` on, until go() is called again.
  void go(int source) {
    for (const int node : reached_) distance_[node] = kInfinite;
    reached_.assign(1, source);
    distance_[source] = 0;
    if (source != nobody_) run(distance_);
  }
  double to(int z) const { return std::min(distance_[z], distance_[nobody_] + from_nobody_[z]); }

 private:
  std::size_t first_at(const Change& change) const { return &change - changes_.data(); }

  /// Dijkstra from those reached so far, not on from nobody.
  void run(ScratchVector<double>& distance) {
    for (std::size_t done = 0; done < reached_.size(); ++done) {
      std::size_t nearest = done;
      for (std::size_t i = done + 1; i < reached_.size(); ++i)
        if (distance[reached_[i]] < distance[reached_[nearest]]) nearest = i;
      std::swap(reached_[done], reached_[nearest]);
      const int node = reached_[done];
      if (node == nobody_) continue;
      for (std::size_t i = first_[node]; i < first_[node + 1]; ++i) {
        const auto& [loser, taker, slack, loss] = changes_[i];
        const double far = distance[node] + slack;
        if (far > reach_ || far >= distance[loser]) continue;
        if (distance[loser] == kInfinite) reached_.push_back(loser);
        distance[loser] = far;
      }
    }
  }

  const ScratchVector<Change>& changes_;  // by taker
  double reach_;
  int nobody_;
  ScratchVector<std::size_t> first_;  // per taker
  ScratchVector<double> distance_, from_nobody_;
  ScratchVector<int> reached_;
};

}  // namespace

ChangeLosses::ChangeLosses(const PairGains& gains, const Assignment& best, double reach)
    : of_none_(gains.detections(), kInfinite), reach_(reach) {
  const int nobody = gains.detections();
  ScratchVector<int> owner(gains.leaves(), nobody);
  for (int z = 0; z < nobody; ++z)
    if (best.choice(z) != Assignment::kNone) owner[best.choice(z)] = z;
  std::size_t pairs = 0;
  for (int z = 0; z < nobody; ++z) {
    first_.push_back(pairs);
    pairs += gains.of(z).end() - gains.of(z).begin();
  }
  of_pair_.assign(pairs, kInfinite);

  ScratchVector<Change> changes;
  for (int z = 0; z < nobody; ++z) {
    double* loss = of_pair_.data() + first_[z];
    for (const auto& pair : gains.of(z)) {
      const double slack = pair.leaf == best.choice(z) ? 0 : best.slack(z, pair);
      if (pair.leaf == best.choice(z))
        *loss = 0;
      else if (slack <= reach)
        changes.push_back({owner[pair.leaf], z, std::max(slack, 0.0), loss});
      ++loss;
    }
    if (best.choice(z) == Assignment::kNone)
      of_none_[z] = 0;
    else if (best.slack_of_none(z) <= reach)
      changes.push_back({nobody, z, std::max(best.slack_of_none(z), 0.0), &of_none_[z]});
  }
  Ways ways(changes, best, reach);
  // Those with the same loser share their way on.
  ScratchVector<std::size_t> by_loser(changes.size());
  std::iota(by_loser.begin(), by_loser.end(), 0);
  std::sort(by_loser.begin(), by_loser.end(), [&](std::size_t a, std::size_t b) {
    return changes[a].loser != changes[b].loser ? changes[a].loser < changes[b].loser : a < b;
  });
  int source = -1;
  for (const std::size_t i : by_loser) {
    const auto& [loser, taker, slack, loss] = changes[i];
    if (loser != source) ways.go(source = loser);
    const double all = slack + ways.to(taker);
    if (all > reach) continue;
    *loss = all;
    ++within_;
  }
}

}  // namespace anchord
