#include "mht/factors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <unordered_map>

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
  Factoriser(const HypothesisSet& set, const Cut& cut) : set_(set), cut_(cut) {
    const std::size_t anchors = set.front().leaf.size();
    parent_.resize(anchors);
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t h = 0; h < set.size(); ++h) {
      auto& changes = changes_.emplace_back();
      std::uint64_t key = 0;
      for (std::size_t a = 0; a < anchors; ++a)
        if (set[h].leaf[a] != set[0].leaf[a]) {
          changes.push_back({static_cast<int>(a), set[h].leaf[a]});
          key ^= hash_of(changes.back());
        }
      keys_.push_back(key);
      by_key_.emplace(key, static_cast<int>(h));
    }
    while (unite_unexplained() || unite_exclusive()) {
    }
  }

  std::vector<Factor> factors() {
    std::map<int, Factor> by_root;
    for (int a = 0; a < static_cast<int>(parent_.size()); ++a)
      by_root[find(a)].anchors.push_back(a);
    for (std::size_t h = 0; h < set_.size(); ++h) {
      if (changes_[h].empty()) {
        for (auto& [root, factor] : by_root) add(factor, static_cast<int>(h));
      } else if (const int root = only_group(static_cast<int>(h)); root >= 0) {
        add(by_root[root], static_cast<int>(h));
      }
    }
    std::vector<Factor> out;
    for (auto& [root, factor] : by_root) {
      normalise(factor.hypotheses);
      out.push_back(std::move(factor));
    }
    return out;
  }

 private:
  int find(int a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void unite(int a, int b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  double log_ratio(int h) const { return set_[h].log_weight - set_[0].log_weight; }

  /// The group that holds all of a hypothesis' changes, or -1.
  int only_group(int h) {
    const int root = find(changes_[h].front().anchor);
    for (const Change& change : changes_[h])
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
    for (std::size_t h = 1; h < set_.size(); ++h) {
      std::map<int, std::uint64_t> parts;  // by group: the key of its changes
      for (const Change& change : changes_[h]) parts[find(change.anchor)] ^= hash_of(change);
      if (parts.size() < 2) continue;
      double log_product = set_[0].log_weight;
      bool explained = true;
      for (const auto& [root, key] : parts) {
        const auto single = by_key_.find(key);
        explained = explained && single != by_key_.end();
        if (explained) log_product += log_ratio(single->second);
      }
      const double product = std::exp(log_product), actual = std::exp(set_[h].log_weight);
      if (explained && std::abs(product - actual) <= cut_.absolute + cut_.relative * product)
        continue;
      for (const auto& [root, key] : parts) unite(parts.begin()->first, root);
      united = true;
    }
    return united;
  }

  /// Joins groups whose changes exclude each other: combinations that should be there are not.
  bool unite_exclusive() {
    std::map<int, std::vector<int>> singles;  // by group, best first
    for (int h = 1; h < static_cast<int>(set_.size()); ++h)
      if (const int root = only_group(h); root >= 0) singles[root].push_back(h);
    bool united = false;
    for (auto i = singles.begin(); i != singles.end(); ++i)
      for (auto j = std::next(i); j != singles.end(); ++j) {
        if (find(i->first) == find(j->first)) continue;
        double missed = 0;
        for (int a : i->second) {
          for (int b : j->second) {
            const double expected = std::exp(set_[0].log_weight + log_ratio(a) + log_ratio(b));
            if (expected <= kClearly * cut_.floor) break;
            if (!by_key_.count(keys_[a] ^ keys_[b])) missed += expected;
          }
          if (missed > cut_.absolute) break;
        }
        if (missed <= cut_.absolute) continue;
        unite(i->first, j->first);
        united = true;
      }
    return united;
  }

  const HypothesisSet& set_;
  Cut cut_;
  std::vector<int> parent_;
  std::vector<std::vector<Change>> changes_;  // per hypothesis, from the best one
  std::vector<std::uint64_t> keys_;
  std::unordered_map<std::uint64_t, int> by_key_;
};

}  // namespace

std::vector<Factor> factorise(const HypothesisSet& set, const Cut& cut) {
  if (set.empty() || set.front().leaf.empty()) return {};
  if (set.front().leaf.size() == 1) return {{{0}, set}};
  return Factoriser(set, cut).factors();
}

}  // namespace anchord
