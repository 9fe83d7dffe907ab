#include "mht/factors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "core/hash_table.h"

namespace anchord {
namespace {

/// How many times the floor a missing combination must weigh to count: the set it was cut from may
/// have been cut before.
constexpr double kClearly = 4;

struct Change {
  int anchor, leaf;
  bool operator==(const Change&) const = default;
};

/// The same for the same changes, whatever their order; of no changes 0; of the changes of two
/// disjoint sets of anchors the exclusive or.
std::uint64_t hash_of(const Change& change) {
  std::uint64_t x = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(change.anchor)) << 32) |
                    static_cast<std::uint32_t>(change.leaf);
  x += 0x9e3779b97f4a7c15u;  // splitmix64; not 0 for the first leaf of the first anchor
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

class Factoriser {
 public:
  Factoriser(HypothesisSet whole, const Cut& cut)
      : set_(std::move(whole)), cut_(cut), parent_(set_.front().leaf.size()), by_key_(set_.size()) {
    const HypothesisSet& set = set_;
    const std::size_t anchors = parent_.size();
    std::iota(parent_.begin(), parent_.end(), 0);
    first_.reserve(set.size() + 1);
    keys_.reserve(set.size());
    weights_.reserve(set.size());
    ScratchVector<char> varies(anchors, 0);
    for (std::size_t h = 0; h < set.size(); ++h) {
      first_.push_back(changes_.size());
      std::uint64_t key = 0;
      for (std::size_t a = 0; a < anchors; ++a)
        if (set[h].leaf[a] != set[0].leaf[a]) {
          changes_.push_back({static_cast<int>(a), set[h].leaf[a]});
          key ^= hash_of(changes_.back());
          varies[a] = 1;
        }
      keys_.push_back(key);
      weights_.push_back(std::exp(set[h].log_weight));
      by_key_.insert(key, static_cast<int>(h));
    }
    first_.push_back(changes_.size());
    groups_ = static_cast<int>(std::count(varies.begin(), varies.end(), 1));
    while (groups_ > 1 && (unite_unexplained() || (groups_ > 1 && unite_exclusive()))) {
    }
  }

  /// Takes the set: to be called once.
  PoolVector<Factor> factors() {
    PoolVector<Factor> out;
    out.reserve(parent_.size());
    ScratchVector<int> factor_of(parent_.size(), -1);  // per root
    for (int a = 0; a < static_cast<int>(parent_.size()); ++a) {
      int& factor = factor_of[find(a)];
      if (factor < 0) {
        factor = static_cast<int>(out.size());
        out.emplace_back();
      }
      out[factor].anchors.push_back(a);
    }
    if (out.size() == 1) {
      out.front().hypotheses = std::move(set_);
      return out;
    }
    for (int h = 0; h < static_cast<int>(set_.size()); ++h) {
      if (changes(h).empty())
        for (Factor& factor : out) add(factor, h);
      else if (const int root = only_group(h); root >= 0)
        add(out[factor_of[root]], h);
    }
    for (Factor& factor : out) normalise(factor.hypotheses);
    return out;
  }

 private:
  /// Some of the changes of a hypothesis: those in one group.
  struct Part {
    int root;
    std::uint64_t key;
  };

  int find(int a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void unite(int a, int b) {
    a = find(a), b = find(b);
    if (a != b) --groups_;
    parent_[std::max(a, b)] = std::min(a, b);
  }

  std::span<const Change> changes(int h) const {
    return {changes_.data() + first_[h], changes_.data() + first_[h + 1]};
  }

  /// The group that holds all of a hypothesis' changes, or -1.
  int only_group(int h) {
    const int root = find(changes(h).front().anchor);
    for (const Change& change : changes(h))
      if (find(change.anchor) != root) return -1;
    return root;
  }

  void add(Factor& factor, int h) const {
    Hypothesis part{set_[h].log_weight, {}};
    for (int a : factor.anchors) part.leaf.push_back(set_[h].leaf[a]);
    factor.hypotheses.push_back(std::move(part));
  }

  /// Joins groups whose joint changes do not weigh the product of their single ones.
  bool unite_unexplained() {
    bool united = false;
    SmallScratchVector<Part, 16> parts;
    for (int h = 1; h < static_cast<int>(set_.size()); ++h) {
      parts.clear();
      for (const Change& change : changes(h)) {
        const int root = find(change.anchor);
        const auto at = std::find_if(parts.begin(), parts.end(),
                                     [root](const Part& part) { return part.root == root; });
        if (at == parts.end())
          parts.push_back({root, hash_of(change)});
        else
          at->key ^= hash_of(change);
      }
      if (parts.size() < 2) continue;
      double product = weights_[0];
      bool explained = true;
      for (const Part& part : parts) {
        const int single = by_key_.find(part.key);
        explained = explained && single >= 0;
        if (explained) product *= weights_[single] / weights_[0];
      }
      if (explained && std::abs(product - weights_[h]) <= cut_.absolute + cut_.relative * product)
        continue;
      for (const Part& part : parts) unite(parts.front().root, part.root);
      united = true;
    }
    return united;
  }

  /// Joins groups whose changes exclude each other: combinations that should be there are not.
  bool unite_exclusive() {
    ScratchVector<std::pair<int, int>> singles;  // group and hypothesis; in a group best first
    for (int h = 1; h < static_cast<int>(set_.size()); ++h)
      if (const int root = only_group(h); root >= 0) singles.push_back({root, h});
    std::sort(singles.begin(), singles.end());
    ScratchVector<std::size_t> groups;  // where they begin
    for (std::size_t i = 0; i < singles.size(); ++i)
      if (i == 0 || singles[i].first != singles[i - 1].first) groups.push_back(i);
    groups.push_back(singles.size());
    bool united = false;
    for (std::size_t g = 0; g + 2 < groups.size(); ++g)
      for (std::size_t k = g + 1; k + 1 < groups.size(); ++k) {
        const int one = singles[groups[g]].first, other = singles[groups[k]].first;
        if (find(one) == find(other)) continue;
        double missed = 0;
        for (std::size_t i = groups[g]; i < groups[g + 1] && missed <= cut_.absolute; ++i)
          for (std::size_t j = groups[k]; j < groups[k + 1]; ++j) {
            const int a = singles[i].second, b = singles[j].second;
            const double expected = weights_[a] * weights_[b] / weights_[0];
            if (expected <= kClearly * cut_.floor) break;
            if (by_key_.find(keys_[a] ^ keys_[b]) < 0) missed += expected;
          }
        if (missed <= cut_.absolute) continue;
        unite(one, other);
        united = true;
      }
    return united;
  }

  HypothesisSet set_;
  Cut cut_;
  ScratchVector<int> parent_;
  int groups_ = 0;                 // of anchors that vary
  ScratchVector<Change> changes_;  // of all hypotheses, from the best one
  ScratchVector<std::size_t> first_;
  ScratchVector<std::uint64_t> keys_;
  ScratchVector<double> weights_;
  HashTable by_key_;
};

}  // namespace

PoolVector<Factor> factorise(HypothesisSet set, const Cut& cut) {
  if (set.empty() || set.front().leaf.empty()) return {};
  if (set.front().leaf.size() == 1) {
    PoolVector<Factor> one;
    one.push_back({{0}, std::move(set)});
    return one;
  }
  const Scratch scratch;
  return Factoriser(std::move(set), cut).factors();
}

}  // namespace anchord
