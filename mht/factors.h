#pragma once

#include <vector>

#include "mht/hypothesis_set.h"

namespace anchord {

/// Some anchors of a cluster with their own hypotheses, independent of the cluster's others.
struct Factor {
  PoolVector<int> anchors;   ///< ascending
  HypothesisSet hypotheses;  ///< over these anchors, in this order; normalised, best first
};

/// What pruning may have done to a set, for telling dependence from what was cut off.
struct Cut {
  /// The least weight that the cut has left. That a combination of changes is missing tells of
  /// dependence only if it should weigh clearly more.
  double floor = 0;
  /// Probability that may be off altogether...
  double absolute = 0;
  /// ... and how far a combination's weight may be off the product's, relative to it: parents lose
  /// different shares of their children.
  double relative = 0;
};

/// The independent factors of a set, in order of their first anchor; their product is the set.
///
/// Each hypothesis is read as the best one with some anchors changed. Anchors are independent where
/// changes of several weigh, relative to the best, what the changes weigh one by one; a factor
/// holds the changes within it. A set that has been cut to its best hypotheses is so completed by
/// the tail of the product.
///
/// The set must be normalised, best first and without equal hypotheses.
PoolVector<Factor> factorise(HypothesisSet set, const Cut& cut);

}  // namespace anchord
