#pragma once

#include <vector>

#include "mht/hypothesis_set.h"

namespace anchord {

/// How far from independent the groups of factors() may be, in total variation: any two of them,
/// and the product of all groups' marginals from the set. A set that has been cut to its best
/// hypotheses lacks the tail of a product, which the second allows for.
struct Independence {
  double pair = 0, whole = 0;
};

/// Groups of a cluster's anchors whose choices of leaf are independent of the other groups'. Each
/// group ascending, groups in order of their first anchor. One group if the set does not
/// factorise. The set must be normalised and without equal hypotheses.
std::vector<std::vector<int>> factors(const HypothesisSet& set, const Independence& allowed);

}  // namespace anchord
