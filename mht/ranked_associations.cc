#include "mht/ranked_associations.h"

#include <algorithm>

namespace anchord {
namespace {

/// Where what is within reach has all been given, the next reach. No association is likely to be
/// just that far below the best.
constexpr double kFurther = 1.25;
/// From here on all of it.
constexpr double kMostReach = 100;

template <typename Leaves>
void choose(const Block& block, int rank, Leaves& leaf_of) {
  for (std::size_t i = 0; i < block.detections.size(); ++i) {
    const int leaf = block.ranked.leaf_of(rank, static_cast<int>(i));
    leaf_of[block.detections[i]] =
        leaf == Assignment::kNone ? Association::kNone : block.leaves[leaf];
  }
}

}  // namespace

RankedAssociations::RankedAssociations(const AssociationProblem& problem, double log_least)
    : problem_(problem),
      log_least_(log_least),
      reach_(-log_least),
      components_(problem, -log_least) {
  choices_.reserve(problem_.parents.size());
  nodes_.reserve(2 * problem_.parents.size());
  heap_.reserve(2 * problem_.parents.size());
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
  nodes_.clear();
  heap_.clear();
  for (std::size_t p = 0; p < choices_.size(); ++p) {
    Choices& choices = choices_[p];
    if (choices.best < best_ + log_least_) continue;
    choices.blocks.clear();
    choices.leaf_of.clear();
    for (const int c : choices.components)
      for (Block& block : components_.at(c).blocks) choices.blocks.push_back(&block);
    push({choices.best, static_cast<int>(p)});
  }
}

void RankedAssociations::push(const Node& node) {
  heap_.push_back({node.log_weight, static_cast<int>(nodes_.size())});
  nodes_.push_back(node);
  std::push_heap(heap_.begin(), heap_.end());
}

/// The next rank of a block, where the others are as in `rest` and all together weigh `log_weight`.
void RankedAssociations::push_change(int rest, int block, int rank, double log_weight, int parent) {
  RankedAssignments& ranked = choices_[parent].blocks[block]->ranked;
  if (!ranked.has(rank)) return;
  log_weight += ranked.gain(rank) - ranked.gain(rank - 1);
  if (log_weight >= best_ + log_least_) push({log_weight, parent, block, rank, rest});
}

/// Each combination is reached once: by counting up its blocks in their order.
void RankedAssociations::push_children(int index) {
  const Node node = nodes_[index];
  const int blocks = static_cast<int>(choices_[node.parent].blocks.size());
  if (node.block != kNothing)
    push_change(node.rest, node.block, node.rank + 1, node.log_weight, node.parent);
  for (int b = node.block + 1; b < blocks; ++b)
    push_change(index, b, 1, node.log_weight, node.parent);
}

/// The best node that has not been given; kNothing: within reach there is none.
int RankedAssociations::pop() {
  if (heap_.empty()) return kNothing;
  std::pop_heap(heap_.begin(), heap_.end());
  const auto [log_weight, node] = heap_.back();
  heap_.pop_back();
  push_children(node);
  return log_weight >= best_ - reach_ ? node : kNothing;
}

Association RankedAssociations::best_of(int parent) {
  Choices& choices = choices_[parent];
  if (choices.leaf_of.empty()) {
    choices.leaf_of.assign(problem_.detections, Association::kNone);
    for (const int c : choices.components) {
      const Component& component = components_.at(c);
      for (std::size_t i = 0; i < component.detections.size(); ++i)
        choices.leaf_of[component.detections[i]] = component.best_leaf[i];
      for (const Block& block : component.blocks) choose(block, 0, choices.leaf_of);
    }
  }
  Association best{parent, choices.best, {}};
  best.leaf_of.assign(choices.leaf_of.begin(), choices.leaf_of.end());
  return best;
}

Association RankedAssociations::association_of(int index) {
  const Node& node = nodes_[index];
  Association found = best_of(node.parent);
  found.log_weight = node.log_weight;
  for (int n = index; n != kNothing && nodes_[n].block != kNothing; n = nodes_[n].rest)
    choose(*choices_[node.parent].blocks[nodes_[n].block], nodes_[n].rank, found.leaf_of);
  return found;
}

ScratchVector<double> RankedAssociations::log_evidence() const {
  ScratchVector<double> of_component;
  for (int c = 0; c < components_.count(); ++c)
    of_component.push_back(components_.at(c).log_total());
  ScratchVector<double> evidence;
  for (std::size_t p = 0; p < choices_.size(); ++p) {
    evidence.push_back(problem_.parents[p].log_weight);
    for (const int c : choices_[p].components) evidence.back() += of_component[c];
  }
  return evidence;
}

std::optional<Association> RankedAssociations::next() {
  int node = pop();
  while (node == kNothing) {
    if (!components_.large() || reach_ >= -log_least_) return std::nullopt;
    const double next = reach_ < kMostReach ? kFurther * reach_ : -kLogZero;
    reach_ = std::min(next, -log_least_);
    start();
    for (std::size_t i = 0; i < given_; ++i) pop();
    node = pop();
  }
  ++given_;
  return association_of(node);
}

}  // namespace anchord
