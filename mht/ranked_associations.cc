#include "mht/ranked_associations.h"

#include <algorithm>
#include <limits>

namespace anchord {
namespace {
constexpr double kInfinite = std::numeric_limits<double>::infinity();
}

RankedAssociations::RankedAssociations(const AssociationProblem& problem, double log_least)
    : problem_(problem), costs_(problem.parents.size()), log_least_(log_least) {
  for (std::size_t p = 0; p < problem.parents.size(); ++p) {
    const auto& parent = problem.parents[p];
    double bound = parent.log_weight;  // every detection gets its best leaf, shared or not
    for (int z = 0; z < problem.detections; ++z) {
      double best = 0;
      for (int leaf : parent.leaves)
        best = std::max(best, problem.gain[leaf * problem.detections + z]);
      bound += best;
    }
    push({bound, static_cast<int>(p), false, -1, Assignment(0, 0), {}, {}});
  }
}

void RankedAssociations::push(Node node) {
  enter({node.bound, nodes_.size()});
  nodes_.push_back(std::move(node));
}

void RankedAssociations::enter(Entry entry) {
  heap_.push_back(entry);
  std::push_heap(heap_.begin(), heap_.end());
}

const std::vector<double>& RankedAssociations::costs_of(int parent) {
  auto& costs = costs_[parent];
  const auto& leaves = problem_.parents[parent].leaves;
  if (costs.empty() && problem_.detections > 0) {
    costs.reserve(problem_.detections * (leaves.size() + 1));
    for (int z = 0; z < problem_.detections; ++z) {
      for (int leaf : leaves) costs.push_back(-problem_.gain[leaf * problem_.detections + z]);
      costs.push_back(0);
    }
  }
  return costs;
}

bool RankedAssociations::solve(Node& node) {
  const auto& costs = costs_of(node.parent);
  const auto& parent = problem_.parents[node.parent];
  if (node.banned_row < 0) {
    node.assignment = Assignment(problem_.detections, static_cast<int>(parent.leaves.size()));
    node.assignment.solve(costs);
    node.fixed.assign(problem_.detections, 0);
  } else {
    scratch_ = costs;
    for (int entry : node.banned) scratch_[entry] = kInfinite;
    if (!node.assignment.reassign(node.banned_row, scratch_, node.fixed)) return false;
  }
  node.bound = parent.log_weight - node.assignment.cost(costs);
  node.solved = true;
  return true;
}

/// Splits what is left of a solved node: for each free row in turn, rows before it keep their
/// choice and the row itself loses it.
void RankedAssociations::branch(const Node& node) {
  const auto& costs = costs_of(node.parent);
  scratch_ = costs;
  for (int entry : node.banned) scratch_[entry] = kInfinite;
  const int width = node.assignment.leaves() + 1;
  RowFlags fixed = node.fixed;
  for (int z = 0; z < problem_.detections; ++z) {
    if (fixed[z]) continue;
    const double loss = node.assignment.least_loss(z, scratch_);
    if (node.bound - loss > least_bound_) {
      Node child{node.bound - loss, node.parent, false, z, node.assignment, fixed, {}};
      for (int entry : node.banned)
        if (!fixed[entry / width]) child.banned.push_back(entry);
      child.banned.push_back(z * width + node.assignment.choice(z));
      push(std::move(child));
    }
    fixed[z] = 1;
  }
}

std::optional<Association> RankedAssociations::next() {
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const std::size_t index = heap_.back().node;
    heap_.pop_back();
    Node& node = nodes_[index];  // a deque's elements stay where they are
    if (!node.solved) {
      if (!solve(node)) continue;
      if (!heap_.empty() && node.bound < heap_.front().bound) {
        enter({node.bound, index});
        continue;
      }
    }
    if (least_bound_ == kLogZero) least_bound_ = node.bound + log_least_;
    branch(node);
    Association found{node.parent, node.bound, {}};
    found.leaf_of.resize(problem_.detections);
    const int none = node.assignment.leaves();
    for (int z = 0; z < problem_.detections; ++z) {
      const int choice = node.assignment.choice(z);
      found.leaf_of[z] = choice == none ? Association::kNone : choice;
    }
    return found;
  }
  return std::nullopt;
}

}  // namespace anchord
