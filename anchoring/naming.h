#pragma once

#include "anchoring/belief.h"

namespace anchord {

/// Names the anchors of the clusters from `first_cluster` on that have come to p >= 0.5 or stand
/// in the best world for the first time: their most probable class and a number that counts up
/// per class, in order of birth. Names are never changed or used again.
void name_anchors(Belief& belief, std::size_t first_cluster, const Background& background);

}  // namespace anchord
