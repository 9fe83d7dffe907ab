#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "mht/association_problem.h"
#include "mht/change_losses.h"
#include "mht/ranked_assignments.h"

namespace anchord {

/// Detections whose choices do not depend on any others', with their ranked assignments.
struct Block {
  ScratchVector<int> detections;  ///< of the problem
  ScratchVector<int> leaves;      ///< of the problem; assignments count positions in it
  RankedAssignments ranked;
};

/// Some leaves and all detections that they may be given: as far as pairs go, apart from the rest
/// of a parent. Many parents share it, and its ranking.
struct Component {
  ScratchVector<int> leaves;      ///< of the problem, in the order of the parent
  ScratchVector<int> detections;  ///< of the problem
  double best = 0;                ///< what its best assignment gains
  ScratchVector<int> best_leaf;   ///< per detection: a leaf of the problem or Association::kNone
  ScratchVector<Block> blocks;    ///< that have more than one assignment

  /// Of a component of many detections: positions in `detections` and `leaves`.
  struct Solved {
    PairGains gains;
    Assignment best;
    std::optional<ChangeLosses> losses;  ///< within the reach that was last asked for
  };
  Solved* solved = nullptr;  ///< null where there are few

  /// ln of the sum of e^gain over all its assignments, as far as they have been ranked.
  double log_total() const;
};

/// The components of a problem's parents, each made once.
class Components {
 public:
  /// What gains less than the best of a component by more than `most_loss` may be left out.
  Components(const AssociationProblem& problem, double most_loss);

  /// Numbers of a parent's components; at() gives them.
  ScratchVector<int> of(const AssociationProblem::Parent& parent);
  Component& at(int component) { return components_[component]; }
  const Component& at(int component) const { return components_[component]; }
  int count() const { return static_cast<int>(components_.size()); }

  /// Whether there are components of many detections. They have no blocks until take_apart().
  bool large() const { return large_; }

  /// A reach (see take_apart()) within which there are some, but not many assignments.
  double first_reach();

  /// Makes the blocks of components of many detections anew, for assignments that gain less than
  /// the best one by at most `reach`: a pair that is in none of them is left out (see
  /// ChangeLosses).
  void take_apart(double reach);

 private:
  int find(int z);
  int known(const ScratchVector<int>& leaves);
  int* slot_of(const ScratchVector<int>& leaves);
  void make(const ScratchVector<int>& leaves, Component& component);

  const AssociationProblem& problem_;
  double most_loss_;
  bool large_ = false;
  std::deque<Component, ScratchAllocator<Component>> components_;
  std::deque<Component::Solved, ScratchAllocator<Component::Solved>> solved_;
  ScratchVector<int> table_;     // of components by their leaves' hash; -1 where there is none
  ScratchVector<int> parent_;    // of a detection, among those that share a leaf
  ScratchVector<int> position_;  // of a detection in the component that is made
  // Of a parent: its leaves that have gains, by the root of their detections; those of one root.
  ScratchVector<std::pair<int, int>> by_root_;
  ScratchVector<int> together_;
};

}  // namespace anchord
