#pragma once

#include <vector>

#include "anchoring/association.h"

namespace anchord {

/// Clusters and detections that must be associated together.
struct Group {
  ScratchVector<PredictedCluster> clusters;
  ScratchVector<int> detections;  ///< ascending
};

/// Brings together what one frame ties: a cluster and a detection that one of its leaves may be
/// given. In a crowd gates overlap until all is one; so where hypotheses are bounded by
/// Limits::min_weight, a detection ties a cluster only if it comes from there with at least that
/// probability (estimated over all that are tied, see mht/marginals.h), and with less than 0.03
/// only where no more hypotheses that are as probable come together than may be kept. What it might
/// have been given to otherwise is let go. Groups in order of their first cluster, then those of
/// detections alone.
ScratchVector<Group> couple(ScratchVector<PredictedCluster> clusters, int detections,
                            const Limits& limits);

}  // namespace anchord
