#include "mht/hypothesis_set.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>

#include "core/hash_table.h"
#include "core/log_probability.h"
#include "core/scratch.h"

namespace anchord {
namespace {

/// FNV-1a over the leaf numbers.
std::uint64_t hash_of(const Hypothesis& h) {
  std::uint64_t hash = 14695981039346656037u;
  for (int leaf : h.leaf) hash = (hash ^ static_cast<std::uint32_t>(leaf)) * 1099511628211u;
  return hash;
}

}  // namespace

double normalise(HypothesisSet& set) {
  if (set.size() == 1) return std::exchange(set.front().log_weight, 0);
  const auto better = [](const Hypothesis& a, const Hypothesis& b) {
    return a.log_weight > b.log_weight;
  };
  if (!std::is_sorted(set.begin(), set.end(), better)) {
    const Scratch scratch;
    ScratchVector<std::pair<double, int>> order;  // a stable sort, without memory of its own
    for (const Hypothesis& h : set)
      order.push_back({-h.log_weight, static_cast<int>(order.size())});
    std::sort(order.begin(), order.end());
    HypothesisSet sorted;
    sorted.reserve(set.size());
    for (const auto& [weight, i] : order) sorted.push_back(std::move(set[i]));
    set = std::move(sorted);
  }
  const double total = log_sum(set, [](const Hypothesis& h) { return h.log_weight; });
  for (auto& h : set) h.log_weight -= total;
  return total;
}

void merge_equal(HypothesisSet& set) {
  if (set.size() == 1) {
    normalise(set);
    return;
  }
  const Scratch scratch;
  HashTable by_hash(set.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::uint64_t hash = hash_of(set[i]);
    const int equal = by_hash.find(hash, [&](int other) { return set[other].leaf == set[i].leaf; });
    if (equal >= 0) {
      set[equal].log_weight = log_add(set[equal].log_weight, set[i].log_weight);
      continue;
    }
    by_hash.insert(hash, static_cast<int>(kept));
    if (kept != i) set[kept] = std::move(set[i]);
    ++kept;
  }
  set.resize(kept);
  normalise(set);
}

double prune(HypothesisSet& set, int max, double min_weight) {
  std::size_t keep = max > 0 ? std::min<std::size_t>(set.size(), max) : set.size();
  const double least = min_weight > 0 ? std::log(min_weight) : kLogZero;
  while (keep > 1 && set[keep - 1].log_weight < least) --keep;
  double dropped = 0;
  for (std::size_t i = keep; i < set.size(); ++i) dropped += std::exp(set[i].log_weight);
  if (keep == set.size()) return 0;
  set.resize(keep);
  normalise(set);
  return dropped;
}

HypothesisSet join(const HypothesisSet& a, const HypothesisSet& b, int max, double min_weight,
                   double* dropped) {
  struct Pair {
    double log_weight;
    std::size_t i, j;
    bool operator<(const Pair& o) const {
      if (log_weight != o.log_weight) return log_weight < o.log_weight;
      return i != o.i ? i > o.i : j > o.j;
    }
  };
  const auto weight = [&](std::size_t i, std::size_t j) {
    return a[i].log_weight + b[j].log_weight;
  };
  const double least = min_weight > 0 ? std::log(min_weight) : kLogZero;
  HypothesisSet out;
  // Pair (i, j) is reached from (i, j - 1); (i, 0) from (i - 1, 0): each once.
  const Scratch scratch;
  std::priority_queue<Pair, ScratchVector<Pair>> heap;
  heap.push({weight(0, 0), 0, 0});
  while (!heap.empty() && (max == 0 || out.size() < static_cast<std::size_t>(max))) {
    const Pair top = heap.top();
    heap.pop();
    if (top.log_weight < least && !out.empty()) break;
    Hypothesis h{top.log_weight, a[top.i].leaf};
    h.leaf.insert(h.leaf.end(), b[top.j].leaf.begin(), b[top.j].leaf.end());
    out.push_back(std::move(h));
    if (top.j + 1 < b.size()) heap.push({weight(top.i, top.j + 1), top.i, top.j + 1});
    if (top.j == 0 && top.i + 1 < a.size()) heap.push({weight(top.i + 1, 0), top.i + 1, 0});
  }
  const double log_total = normalise(out);
  if (dropped) *dropped += std::max(0.0, -std::expm1(log_total));
  return out;
}

HypothesisSet marginal(const HypothesisSet& set, std::span<const int> anchors) {
  HypothesisSet out;
  out.reserve(set.size());
  for (const auto& h : set) {
    Hypothesis part{h.log_weight, {}};
    part.leaf.reserve(anchors.size());
    for (int a : anchors) part.leaf.push_back(h.leaf[a]);
    out.push_back(std::move(part));
  }
  merge_equal(out);
  return out;
}

}  // namespace anchord
