#pragma once

#include <vector>

#include "mht/hypothesis_set.h"

namespace anchord {

/// Groups of a cluster's anchors whose choices of leaf are independent of the other groups': the
/// product of the groups' marginals differs from the set by a total variation of at most
/// `tolerance`. Each group ascending, groups in order of their first anchor. One group if the
/// set does not factorise. The set must be normalised and without equal hypotheses.
std::vector<std::vector<int>> factors(const HypothesisSet& set, double tolerance);

}  // namespace anchord
