#pragma once

#include <memory>
#include <vector>

#include "anchoring/belief.h"

namespace anchord {

/// Whether making one of two versions of an object, the rarer of that probability, loses nothing
/// that matters: see merge_alike().
bool alike(const Leaf& a, const Leaf& b, double rarer, const Background& background);

/// Makes one of versions of an anchor that are alike (their difference() is small) where that loses
/// nothing that matters: where the rarer one is rare enough, or where both were given the same
/// detections in the last `scan_depth` frames, so that they differ only in the distant past.
/// Versions are merged by moments; hypotheses that become equal are one.
void merge_alike(Cluster& cluster, const Background& background);

/// A cluster as the independent clusters it consists of (mht/factors.h), without leaves and
/// anchors that no hypothesis uses. Anchors keep their order; clusters stand in order of their
/// first anchor. Where hypotheses are bounded at all, a dependence of that order is let go.
/// `least`: hypotheses of less probability may have been cut off.
PoolVector<std::shared_ptr<const Cluster>> split(Cluster cluster, const Background& background,
                                                 double least = 0);

}  // namespace anchord
