#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anchoring/leaf.h"
#include "mht/hypothesis_set.h"
#include "models/moving_intensity.h"
#include "models/undetected_intensity.h"

namespace anchord {

/// An object of at least this probability is believed in: it gets a name, and stands in a best
/// world of whose leaf this is the r.
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
  std::vector<std::shared_ptr<const Leaf>> leaves;
  int shown = Hypothesis::kNoLeaf;  ///< the leaf in the world that is shown
};

/// Anchors whose associations do not interact with any other's, and the possible worlds among
/// them. Immutable once made.
struct Cluster {
  std::vector<AnchorTree> anchors;
  HypothesisSet hypotheses;  ///< normalised, best first; leaf numbers index AnchorTree::leaves
  int leading = 0;           ///< the hypothesis that the best world shows, see choose_leading()

  /// P(the anchor exists) = sum over hypotheses of P(h) r, at the time of its leaves.
  double existence(int anchor) const;
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

/// All that is believed after some frames. A value that shares what did not change: copying one
/// costs a pointer for each cluster. Leaves are lazy: each holds for its own time.
struct Belief {
  Utime utime = 0;  ///< of the newest frame; 0 before the first
  Utime start = 0;  ///< of the first frame
  std::uint64_t frames = 0;
  std::vector<std::shared_ptr<const Cluster>> clusters;
  std::vector<UndetectedIntensity> undetected;  ///< per class
  /// Of what arrives on the move, beside it: per class; empty where nothing does.
  std::vector<MovingIntensity> moving;
  std::uint64_t births = 0;
  std::vector<std::uint64_t> names;  ///< given so far, per class
  std::vector<SetAside> set_aside;   ///< by the newest events that can be undone

  /// Seconds since the start, as the undetected intensities count them.
  double seconds(Utime at) const { return seconds_between(start, at); }
};

}  // namespace anchord
