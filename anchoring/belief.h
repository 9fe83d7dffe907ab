#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anchoring/clusters.h"
#include "anchoring/leaf.h"
#include "core/pool.h"
#include "mht/hypothesis_set.h"
#include "models/moving_intensity.h"
#include "models/undetected_intensity.h"

namespace anchord {

/// An object of at least this probability is believed in: it gets a name, and stands in a best
/// world whose leaf has this real_existence().
inline constexpr double kBelievedIn = 0.5;

/// One object that is believed to exist, whichever hypothesis leads: its identity for life.
struct Anchor {
  std::uint64_t birth = 0;  ///< counts anchors in order of birth (frame, then detection)
  std::string name;         ///< `cup-12`; empty until it has p >= 0.5 or stands in a best world
  std::string alias;        ///< what people call it, or empty
  std::optional<std::string> holder;  ///< the robot that holds it, if one does

  /// The name, or `new-N` before it has one.
  std::string id() const { return name.empty() ? "new-" + std::to_string(birth) : name; }
  /// Whether people or programs may mean it so: by its id, by that of before it had a name, or by
  /// its alias.
  bool is_called(std::string_view text) const {
    if (text.empty()) return false;
    return text == name || text == alias || text == "new-" + std::to_string(birth);
  }
};

/// An anchor with its leaves: one for each history of associations that is kept.
struct AnchorTree {
  std::shared_ptr<const Anchor> anchor;
  PoolVector<std::shared_ptr<const Leaf>> leaves;
  int shown = Hypothesis::kNoLeaf;  ///< the leaf in the world that is shown
};

/// Anchors whose associations do not interact with any other's, and the possible worlds among
/// them. Immutable once made.
struct Cluster {
  PoolVector<AnchorTree> anchors;
  HypothesisSet hypotheses;  ///< normalised, best first; leaf numbers index AnchorTree::leaves
  int leading = 0;           ///< the hypothesis that the best world shows, see choose_leading()

  /// P(the anchor exists and is no phantom), the sum over hypotheses, at the time of its leaves.
  double existence(int anchor, const Background& background) const;
  /// The anchor's leaf in the best world, whatever its r, or null.
  const Leaf* best_leaf(int anchor) const;
};

/// What an event has put aside, should it be undone.
struct SetAside {
  std::int64_t number = 0;                              ///< of the event
  std::vector<std::shared_ptr<const Cluster>> anchors;  ///< as they were, each on its own
  std::uint64_t birth = 0;  ///< of the anchor that was named, or that the others were joined in
  std::optional<std::string> alias;  ///< that it had, if it was named
};

/// What folding frames took, and what it let go.
///
/// Work is counted: one for each version of an anchor that is carried to a frame, and one for each
/// anchor of each hypothesis that is looked at, before the frame and after it. It is about in
/// proportion to the time that is taken, and the same wherever a frame is folded again.
struct Effort {
  std::uint64_t work = 0;
  /// The probability of hypotheses that were left out, summed over clusters: no probability that
  /// the belief gives was moved by more. What lies below `hypotheses.min_weight` and was never
  /// formed is not in it.
  double dropped = 0;
  bool cut = false;  ///< a bound on the work left out hypotheses
};

/// All that is believed after some frames. A value that shares what did not change: copying one
/// costs a pointer for some dozens of clusters. Leaves are lazy: each holds for its own time.
struct Belief {
  Utime utime = 0;  ///< of the newest frame; 0 before the first
  Utime start = 0;  ///< of the first frame
  std::uint64_t frames = 0;
  Clusters clusters;
  std::vector<UndetectedIntensity> undetected;  ///< per class
  /// Of what arrives on the move, beside it: per class; empty where nothing does.
  std::vector<MovingIntensity> moving;
  std::uint64_t births = 0;
  std::vector<std::uint64_t> names;  ///< given so far, per class
  std::vector<SetAside> set_aside;   ///< by the newest events that can be undone
  /// ln of the probability density of all frames so far, the evidence for the configuration: what
  /// divides every sum of weights. A frame adds, for each cluster that it makes, the ln of the sum
  /// of its hypotheses' weights before they are normalised (kappa(z) + e(z) of each detection that
  /// is new or clutter, r g of one that a leaf gives, 1 - r q of a leaf that gives none), less the
  /// number of detections that were expected of clutter and of undetected objects:
  /// kappa times the volume in view, and the sum over classes of p_D,c times the integral of
  /// lambda_c over it. Scores are taken as given: of detections that have one, kappa is the density
  /// at p = 0.5, not that of all clutter. What pruning drops is missing from the sums. Events say
  /// what is so; they add nothing.
  double log_evidence = 0;

  Effort effort;                 ///< by the newest frame that was folded
  double dropped = 0;            ///< Effort::dropped, summed over all frames
  std::uint64_t cut_frames = 0;  ///< those with Effort::cut

  /// Seconds since the start, as the undetected intensities count them.
  double seconds(Utime at) const { return seconds_between(start, at); }
};

}  // namespace anchord
