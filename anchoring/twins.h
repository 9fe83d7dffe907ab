#pragma once

#include "anchoring/belief.h"

namespace anchord {

/// One object under two names: where an anchor is no longer part of a world, and another one has
/// there a version that is alike (see alike()) one of its own and whose last five detections (of
/// the last `scan_depth` frames) are the same, only the past tells which has left. That version
/// then goes by one name, the more probable one (the one that is shown, if it has at least a third
/// of the other's probability), in all those worlds; its probability is their sum. An anchor that
/// somebody has named or holds keeps what it has.
void join_twins(Cluster& cluster, const Background& background);

}  // namespace anchord
