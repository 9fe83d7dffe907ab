#pragma once

#include <map>
#include <memory>
#include <vector>

#include "anchoring/leaf.h"
#include "anchoring/occlusion.h"
#include "geometry/view.h"

namespace anchord {

/// What one view shows of the world: computed once per view, and kept while the view stays. A wall
/// hides what is behind it from an eye; without one the view alone counts.
class Visibility {
 public:
  Visibility(const MapView& view, const std::optional<Eigen::Vector3d>& eye,
             const Background& background);

  /// Whether this is what another frame's view shows, too.
  bool same_for(const MapFrame& frame) const;

  /// What the view means for a predicted leaf of the anchor `birth`, which other objects may hide
  /// in this frame.
  LeafVisibility of(const Leaf& leaf, const std::vector<double>& detection_probability,
                    const Occlusion& occlusion, std::uint64_t birth) const;

  /// What a sensor sees of a density with the mass `seen` in view and not hidden, as of() has it.
  /// What hides it counts as independent of what the view cuts.
  SeenPart part(const Gaussian& density, double seen, const Occlusion& occlusion,
                std::uint64_t birth) const;

  /// Per cell of a footprint the share in view; the footprint is one of the Background's. Objects
  /// hide nothing of it.
  const std::vector<double>& of(const Footprint& footprint) const;

  /// Per cell of the world's grid the share in view, likewise.
  const Look& look() const { return look_; }

  int dims() const { return background_->dims; }

  /// How much of the world is in view, m^dims.
  double volume() const { return volume_; }

 private:
  double exactness(double p) const;
  /// Whether a density is so far from all that is in view that nothing of it counts.
  bool out_of_view(const Kinematic& density) const;
  /// The part of a density in view that no wall hides: its share of that in view, and how both
  /// differ, by points of equal probability.
  struct Clear {
    double share;
    MassDerivatives relative;
  };
  Clear clear_of_walls(const Gaussian& density) const;

  MapView view_;
  std::optional<Eigen::Vector3d> eye_;  ///< none where there are no walls
  const Background* background_;
  Look look_;
  double volume_;
  mutable std::map<const Footprint*, std::vector<double>> footprints_;  // filled when asked for
};

/// How a frame's sensor looks at one anchor.
struct Sight {
  const Visibility& visibility;
  const Occlusion& occlusion;
  std::uint64_t birth;

  /// A predicted density is missed, of which the mass `seen` is in view and not hidden, and would
  /// be detected with probability p. Where next to nothing, or all, is seen it stays as it is.
  void miss(Kinematic& density, double p, double seen) const;

 private:
  /// Of what is left of a density after a miss, the share by which it differs from what it was.
  /// What is missed of it again and again, unlearned, costs 0.04 nat of odds in an hour of 10
  /// frames a second.
  static constexpr double kHardlyNews = 1e-6;
};

}  // namespace anchord
