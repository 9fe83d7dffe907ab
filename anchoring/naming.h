#pragma once

#include "anchoring/belief.h"

namespace anchord {

/// Names the anchors of clusters that have come to p >= 0.5 or stand in the best world for the
/// first time: their most probable class and a number that counts up per class (Belief::names), in
/// order of birth. Names are never changed or used again.
void name_anchors(std::span<std::shared_ptr<const Cluster>> clusters, Belief& belief,
                  const Background& background);

}  // namespace anchord
