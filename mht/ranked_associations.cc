#include "mht/ranked_associations.h"

#include <algorithm>

namespace anchord {
namespace {

/// Where what is within reach has all been given, the next reach. No association is likely to be
/// just that far below the best.
constexpr double kFurther = 1.618033988749895;
/// From here on all of it.
constexpr double kMostReach = 100;

}  // namespace

RankedAssociations::RankedAssociations(const AssociationProblem& problem, double log_least)
    : problem_(problem), log_least_(log_least), reach_(-log_least), components_(problem, -log_least) {
  for (const auto& parent : problem_.parents) {
    Choices& choices = choices_.emplace_back();
    choices.best = parent.log_weight;
    choices.components = components_.of(parent);
    for (const int c : choices.components) choices.best += components_.at(c).best;
    best_ = std::max(best_, choices.best);
  }
  if (components_.large()) reach_ = std::min(components_.first_reach(), -log_least);
  start();
}

void RankedAssociations::start() {
  components_.take_apart(reach_);
  heap_.clear();
  created_ = 0;
  for (std::size_t p = 0; p < choices_.size(); ++p) {
    Choices& choices = choices_[p];
    if (choices.best < best_ + log_least_) continue;
    choices.blocks.clear();
    for (const int c : choices.components)
      for (Block& block : components_.at(c).blocks) choices.blocks.push_back(&block);
    Node node{choices.best, static_cast<int>(p), 0, {}, 0};
    node.rank.assign(choices.blocks.size(), 0);
    push(std::move(node));
  }
}

void RankedAssociations::push(Node node) {
  node.number = created_++;
  heap_.push_back(std::move(node));
  std::push_heap(heap_.begin(), heap_.end());
}

/// Each combination is reached once: by counting up its blocks in their order.
void RankedAssociations::push_children(const Node& node) {
  const auto& blocks = choices_[node.parent].blocks;
  for (int b = node.last; b < static_cast<int>(blocks.size()); ++b) {
    RankedAssignments& ranked = blocks[b]->ranked;
    const int rank = node.rank[b];
    if (!ranked.has(rank + 1)) continue;
    const double log_weight = node.log_weight + (ranked.gain(rank + 1) - ranked.gain(rank));
    if (log_weight < best_ + log_least_) continue;
    Node child{log_weight, node.parent, b, node.rank, 0};
    ++child.rank[b];
    push(std::move(child));
  }
}

bool RankedAssociations::pop(Node& node) {
  if (heap_.empty()) return false;
  std::pop_heap(heap_.begin(), heap_.end());
  node = std::move(heap_.back());
  heap_.pop_back();
  push_children(node);
  return node.log_weight >= best_ - reach_;
}

Association RankedAssociations::association_of(const Node& node) {
  Association found{node.parent, node.log_weight, {}};
  found.leaf_of.resize(problem_.detections, Association::kNone);
  const Choices& choices = choices_[node.parent];
  for (const int c : choices.components) {
    const Component& component = components_.at(c);
    for (std::size_t i = 0; i < component.detections.size(); ++i)
      found.leaf_of[component.detections[i]] = component.best_leaf[i];
  }
  for (std::size_t b = 0; b < choices.blocks.size(); ++b) {
    Block& block = *choices.blocks[b];
    for (std::size_t i = 0; i < block.detections.size(); ++i) {
      const int leaf = block.ranked.leaf_of(node.rank[b], static_cast<int>(i));
      found.leaf_of[block.detections[i]] =
          leaf == Assignment::kNone ? Association::kNone : block.leaves[leaf];
    }
  }
  return found;
}

std::optional<Association> RankedAssociations::next() {
  Node node;
  while (!pop(node)) {
    if (!components_.large() || reach_ >= -log_least_) return std::nullopt;
    const double next = reach_ < kMostReach ? kFurther * reach_ : -kLogZero;
    reach_ = std::min(next, -log_least_);
    start();
    for (std::size_t i = 0; i < given_; ++i) pop(node);
  }
  ++given_;
  return association_of(node);
}

}  // namespace anchord
