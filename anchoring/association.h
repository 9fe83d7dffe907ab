#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "anchoring/belief.h"
#include "anchoring/map_frame.h"
#include "anchoring/nearby.h"
#include "anchoring/visibility.h"
#include "mht/association_problem.h"

namespace anchord {

/// A leaf as one frame finds it: predicted to the frame's time, with what the frame's view and
/// detections mean for it.
struct PredictedLeaf {
  explicit PredictedLeaf(const Leaf& before) : leaf(before) {}

  Leaf leaf;
  LeafVisibility shown;
  double log_miss = 0;  ///< ln(1 - r q)
  /// What it is worth to give the leaf a detection: ln of that, over giving it nothing and the
  /// detection being new or clutter. Only detections that it may be given, ascending.
  AssociationProblem::Gains gains;
};

/// A cluster as one frame finds it.
struct PredictedCluster {
  std::shared_ptr<const Cluster> cluster;
  ScratchVector<ScratchVector<PredictedLeaf>> leaves;  ///< per anchor and leaf
  ScratchVector<char> gated;                           ///< per detection: some leaf may be given it
  bool shown = false;                                  ///< some leaf may be missed
  bool stepped = false;                                ///< must be carried along in any case

  bool touched() const;
  /// Whether no leaf exists with at least this probability any more.
  bool departed(double min_existence) const;
};

/// What a detection is worth without any anchor.
struct Origin {
  ScratchVector<double> terms;   ///< per class p_D,c lambda_c(z) l(z|c)
  double expected = 0;           ///< e(z), their sum
  double log_weight = 0;         ///< ln(kappa(z) + e(z)), doubt included
  double existence = 0;          ///< e / (kappa + e)
  std::optional<Kinematic> met;  ///< what it would be; none: an object at rest at z
};

/// How many hypotheses of a group of clusters may be looked at; nothing: as many as limits say.
struct Allowance {
  std::optional<std::size_t> parents, associations;  ///< before and after the frame
};

/// Folds one frame into a belief whose time is not after the frame's: prediction, association,
/// births, undetected intensity, names. Deterministic.
void fold(Belief& belief, const MapFrame& frame, const Visibility& visibility,
          const Background& background);

/// The parts of fold(), in order.
ScratchVector<Origin> origins(const Belief& belief, const MapFrame& frame,
                              const Background& background);
PredictedCluster predict(std::shared_ptr<const Cluster> cluster, const MapFrame& frame,
                         const ScratchVector<Origin>& origins, const Visibility& visibility,
                         const Occlusion& occlusion, Nearby& nearby, const Background& background);
/// What became of a group.
struct Associated {
  PoolVector<std::shared_ptr<const Cluster>> clusters;
  double log_evidence = 0;  ///< ln of the sum of all associations' weights
  Effort effort;
};
/// Associates `detections` (indices into the frame, ascending) with the clusters that they tie
/// together: the clusters after the frame. Without clusters each detection starts one of its own.
Associated associate(const ScratchVector<PredictedCluster>& clusters,
                     const ScratchVector<int>& detections, const MapFrame& frame,
                     const ScratchVector<Origin>& origins, const Visibility& visibility,
                     const Occlusion& occlusion, const Background& background, const Belief& belief,
                     const Allowance& allowance);

}  // namespace anchord
