#pragma once

#include <vector>

#include "mht/hypothesis_set.h"

namespace anchord {

/// Some anchors of a cluster with their own hypotheses, independent of the cluster's others.
struct Factor {
  std::vector<int> anchors;  ///< ascending
  HypothesisSet hypotheses;  ///< over these anchors, in this order; normalised, best first
};

/// The independent factors of a set, in order of their first anchor; their product is the set.
///
/// Each hypothesis is read as the best one with some anchors changed. Anchors are independent where
/// changes of several weigh, relative to the best, what the changes weigh one by one; a factor
/// holds the changes within it. A set that has been cut to its best hypotheses is so completed by
/// the tail of the product: that a combination is missing tells of dependence only if it should
/// weigh clearly more than `floor`, the least weight that the cut has left. Probabilities that
/// differ by less than `tolerance` from the product's count as equal.
///
/// The set must be normalised, best first and without equal hypotheses.
std::vector<Factor> factorise(const HypothesisSet& set, double floor, double tolerance);

}  // namespace anchord
