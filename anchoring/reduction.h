#pragma once

#include "anchoring/cluster.h"

namespace anchord {

/// Makes room: where a cluster has more than `max` hypotheses, those that are alike in all anchors
/// at once (by difference() of their versions, summed) become one, first the closest ones, until
/// there are `max` or none are alike any more; 0 is no bound. Each goes into the most probable one
/// near it, by moments anchor by anchor; so what is said of each anchor alone stays as it is, and
/// what is lost is how anchors depend within such a group. That is little beside dropping the least
/// probable ones: two objects that move together for a second have thousands of histories of nearly
/// one weight and nearly one state, and of two ways to tell such objects apart the rarer would lose
/// most of its histories, and so its probability.
///
/// After Salmond, "Mixture reduction algorithms for target tracking in clutter", SPIE 1305, 1990
/// (clustering by distance from the most probable component), over the joint state of a cluster.
/// Returns whether any were made one.
bool merge_nearest(Cluster& cluster, int max, const Background& background);

/// Lets go of anchors that never had a name and that over all hypotheses exist with less than
/// `min_probability`, though they may with more in some, once none of their versions had a
/// detection in the last `scan_depth` frames: until then that may grow. Else a place that is seldom
/// in view gathers them by the hundred. What had a name may come back, and is then the same object.
/// With a `scan_depth` of 0 none goes.
void forget_improbable(Cluster& cluster, const Background& background);

}  // namespace anchord
