#include "mht/components.h"

#include <algorithm>
#include <numeric>

#include "core/log_probability.h"

namespace anchord {
namespace {

/// Components of more detections are taken apart by what is wanted.
constexpr int kManyDetections = 8;
/// So many pairs that are not in the best assignment, but in one within reach, make about a
/// hundred assignments.
constexpr int kFewChanges = 24;
/// Where the search for a reach begins and ends; in the logarithm of a weight.
constexpr double kLeastReach = 0.5, kMostReach = 100;

std::uint64_t hash_of(const ScratchVector<int>& leaves) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const int leaf : leaves) hash = (hash ^ static_cast<std::uint32_t>(leaf)) * 1099511628211u;
  return hash;
}

/// Some of a component's detections as a block of their own, if there is anything to choose.
void add_block(const Component& component, const ScratchVector<int>& rows, double reach,
               ScratchVector<Block>& blocks) {
  const auto& [gains, best, losses] = *component.solved;
  ScratchVector<int> detections, leaves, number(gains.leaves(), -1);
  PairGains own(static_cast<int>(rows.size()), 0);
  bool alternative = false;
  for (const int i : rows) {
    detections.push_back(component.detections[i]);
    own.start_row();
    alternative =
        alternative || (best.choice(i) != Assignment::kNone && losses->of_none(i) <= reach);
    std::size_t at = 0;
    for (const auto& pair : gains.of(i)) {
      if (losses->of(i, at++) > reach) continue;
      alternative = alternative || pair.leaf != best.choice(i);
      if (number[pair.leaf] < 0) {
        number[pair.leaf] = static_cast<int>(leaves.size());
        leaves.push_back(component.leaves[pair.leaf]);
      }
      own.add(number[pair.leaf], pair.gain);
    }
  }
  if (!alternative) return;
  own.set_leaves(static_cast<int>(leaves.size()));
  blocks.push_back({std::move(detections), std::move(leaves), {std::move(own), reach, true}});
}

/// Detections that share a leaf in pairs that are wanted belong to one block.
ScratchVector<Block> blocks_of(Component& component, double reach) {
  auto& [gains, best, losses] = *component.solved;
  if (!losses || losses->reach() != reach) losses.emplace(gains, best, reach);
  const int n = gains.detections();
  ScratchVector<int> block(n), holder(gains.leaves(), -1);
  std::iota(block.begin(), block.end(), 0);
  const auto root = [&](int i) {
    while (block[i] != i) i = block[i] = block[block[i]];
    return i;
  };
  for (int i = 0; i < n; ++i) {
    std::size_t at = 0;
    for (const auto& pair : gains.of(i)) {
      if (losses->of(i, at++) > reach) continue;
      if (holder[pair.leaf] < 0) holder[pair.leaf] = i;
      const int a = root(i), b = root(holder[pair.leaf]);
      block[std::max(a, b)] = std::min(a, b);
    }
  }
  ScratchVector<ScratchVector<int>> members(n);
  for (int i = 0; i < n; ++i) members[root(i)].push_back(i);
  ScratchVector<Block> blocks;
  for (const auto& rows : members)
    if (!rows.empty()) add_block(component, rows, reach, blocks);
  return blocks;
}

}  // namespace

double Component::log_total() const {
  double sum = best;
  for (const Block& block : blocks) sum += block.ranked.log_total() - block.ranked.gain(0);
  return sum;
}

Components::Components(const AssociationProblem& problem, double most_loss)
    : problem_(problem),
      most_loss_(most_loss),
      parent_(problem.detections),
      position_(problem.detections, -1) {}

int Components::find(int z) {
  while (parent_[z] != z) z = parent_[z] = parent_[parent_[z]];
  return z;
}

ScratchVector<int> Components::of(const AssociationProblem::Parent& parent) {
  std::iota(parent_.begin(), parent_.end(), 0);
  for (const int leaf : parent.leaves) {
    const auto& gains = problem_.gains[leaf];
    for (std::size_t i = 1; i < gains.size(); ++i)
      parent_[find(gains[i].detection)] = find(gains[0].detection);
  }
  by_root_.clear();
  for (const int leaf : parent.leaves)
    if (!problem_.gains[leaf].empty())
      by_root_.push_back({find(problem_.gains[leaf][0].detection), leaf});
  std::sort(by_root_.begin(), by_root_.end());
  ScratchVector<int> components;
  components.reserve(by_root_.size());
  together_.clear();
  for (std::size_t i = 0; i < by_root_.size(); ++i) {
    together_.push_back(by_root_[i].second);
    if (i + 1 < by_root_.size() && by_root_[i + 1].first == by_root_[i].first) continue;
    components.push_back(known(together_));
    together_.clear();
  }
  return components;
}

int Components::known(const ScratchVector<int>& leaves) {
  if (2 * (components_.size() + 1) > table_.size()) {
    table_.assign(std::max<std::size_t>(64, 4 * table_.size()), -1);
    for (std::size_t c = 0; c < components_.size(); ++c)
      *slot_of(components_[c].leaves) = static_cast<int>(c);
  }
  int* slot = slot_of(leaves);
  if (*slot < 0) {
    *slot = static_cast<int>(components_.size());
    make(leaves, components_.emplace_back());
  }
  return *slot;
}

/// Where these leaves' component stands in the table, or would.
int* Components::slot_of(const ScratchVector<int>& leaves) {
  const std::size_t last = table_.size() - 1;  // the size is a power of two
  std::size_t at = hash_of(leaves) & last;
  while (table_[at] >= 0 && components_[table_[at]].leaves != leaves) at = (at + 1) & last;
  return &table_[at];
}

void Components::make(const ScratchVector<int>& leaves, Component& component) {
  component.leaves = leaves;
  for (const int leaf : leaves)
    for (const auto& gain : problem_.gains[leaf])
      if (position_[gain.detection] < 0) {
        position_[gain.detection] = 0;
        component.detections.push_back(gain.detection);
      }
  std::sort(component.detections.begin(), component.detections.end());
  const int n = static_cast<int>(component.detections.size());
  for (int i = 0; i < n; ++i) position_[component.detections[i]] = i;

  ScratchVector<std::size_t> pairs(n, 0);
  for (const int leaf : leaves)
    for (const auto& gain : problem_.gains[leaf]) ++pairs[position_[gain.detection]];
  PairGains gains(pairs, static_cast<int>(leaves.size()));
  for (std::size_t l = leaves.size(); l-- > 0;)
    for (const auto& [z, gain] : problem_.gains[leaves[l]])
      gains.put(position_[z], --pairs[position_[z]], {static_cast<int>(l), gain});
  for (const int z : component.detections) position_[z] = -1;

  component.best_leaf.assign(n, Association::kNone);
  if (n <= kManyDetections) {
    component.blocks.push_back({component.detections, leaves, {std::move(gains), most_loss_}});
    component.best = component.blocks.back().ranked.gain(0);
    return;
  }
  large_ = true;
  Assignment best(gains);
  component.best = best.gain(gains);
  for (int i = 0; i < n; ++i)
    if (best.choice(i) != Assignment::kNone) component.best_leaf[i] = leaves[best.choice(i)];
  component.solved =
      &solved_.emplace_back(Component::Solved{std::move(gains), std::move(best), std::nullopt});
}

double Components::first_reach() {
  for (double reach = kLeastReach; reach < most_loss_; reach *= 2) {
    int changes = 0;
    for (Component& component : components_) {
      if (!component.solved) continue;
      auto& [gains, best, losses] = *component.solved;
      changes += losses.emplace(gains, best, reach).within_reach();
    }
    if (changes >= kFewChanges) return reach;
    if (reach > kMostReach) break;
  }
  return most_loss_;
}

void Components::take_apart(double reach) {
  for (Component& component : components_)
    if (component.solved) component.blocks = blocks_of(component, reach);
}

}  // namespace anchord
