#pragma once

#include <memory>
#include <optional>

#include "anchoring/association.h"

namespace anchord {

/// The clusters that detections tie together, as one: anchors in order, leaves numbered through.
struct Tied {
  ScratchVector<const PredictedLeaf*> leaves;
  ScratchVector<int> first_leaf;  ///< per anchor
  ScratchVector<std::shared_ptr<const Anchor>> anchors;
  int leading = 0;     ///< the hypothesis that was shown; -1 if it is no longer there
  double dropped = 0;  ///< the probability of hypotheses that were left out
  bool cut = false;    ///< by what is allowed, not by the limits

  /// Over all the anchors; as long as the clusters live.
  const HypothesisSet& hypotheses() const { return of_first_ ? *of_first_ : own_; }
  /// Those of the one cluster that there is; or, of several, a set of their own.
  void refer_to(const HypothesisSet& set) { of_first_ = &set; }
  void keep(HypothesisSet set) {
    own_ = std::move(set);
    of_first_ = nullptr;
  }

 private:
  const HypothesisSet* of_first_ = nullptr;
  HypothesisSet own_;
};

/// Ties clusters together; without any there is one hypothesis, of no anchors. `most`: so many
/// hypotheses may be kept, if that is less than the limits say. The clusters must outlive it.
Tied tie(const ScratchVector<PredictedCluster>& clusters, const Limits& limits,
         std::optional<std::size_t> most);

/// The association of `detections` (indices into the frame, ascending) with what is tied, leaves
/// numbered as in it, detections by their position.
AssociationProblem problem_of(const Tied& tied, const ScratchVector<int>& detections);

}  // namespace anchord
