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
  Visibility(const MapFrame& frame, const Background& background);

  /// Whether this is what another frame's view shows, too.
  bool same_for(const MapFrame& frame) const;

  /// What the view means for a predicted leaf of the anchor `birth`, which other objects may hide
  /// in this frame.
  LeafVisibility of(const Leaf& leaf, const Sensor& sensor, const Occlusion& occlusion,
                    std::uint64_t birth) const;

  /// Notes of the densities of a leaf that was just given a detection how much of them is in view:
  /// there the object is. `birth` is its anchor.
  void find(Leaf& leaf, const Occlusion& occlusion, std::uint64_t birth) const;

  /// What is in view of a density, with SeenPart::toward.
  SeenPart aimed(SeenPart part, const Kinematic& density) const;

  /// Per cell of a footprint the share in view; the footprint is one of the Background's. Objects
  /// hide nothing of it.
  const CellShares& of(const Footprint& footprint) const;

  /// Per cell of the world's grid the share in view, likewise.
  const Look& look() const { return look_; }
  /// The same, times p at the cell: there its distance is that in the plane, and to the column's
  /// nearest height.
  const Look& look(const DetectionProbability& p) const;

  /// How far a point is from the sensor, m; 0 where that did not say where it is.
  double range(const Eigen::Vector3d& point) const { return from_ ? (point - *from_).norm() : 0; }

  /// How much of the world is in view, m^dims.
  double volume() const { return volume_; }

 private:
  double range_of(const Grid& grid, int cell) const;
  std::vector<double> shares_of(const Footprint& footprint) const;
  /// The share of a box that is in view and that no wall hides.
  double share_of(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;
  double range(const Somewhere& somewhere) const;
  double exactness(double p) const;
  /// How much of a density is in view and not hidden; `p`: the probability that it is there.
  SeenPart part(const Kinematic& density, double p, const Occlusion& occlusion,
                std::uint64_t birth) const;
  /// Whether a density is so far from all that is in view that nothing of it counts.
  bool out_of_view(const Kinematic& density) const;
  /// The share of the part in view of a density that no wall hides.
  double clear_of_walls(const Gaussian& density) const;

  std::uint32_t viewer_;  ///< MapFrame::viewer of that sensor
  MapView view_;
  std::optional<Eigen::Vector3d> eye_;   ///< none where there are no walls
  std::optional<Eigen::Vector3d> from_;  ///< the eye, none where no p_D depends on the distance
  const Background* background_;
  Walls walls_;  ///< those that may stand between the eye and what is in view
  Look look_;
  double volume_;
  double hardly_;  ///< what is there to be seen with less probability is not missed
  // Filled when asked for:
  mutable std::map<const Footprint*, CellShares> footprints_;
  mutable std::map<const Footprint*, double> ranges_;
  mutable std::map<std::pair<double, double>, Look> looks_;  // by near, per_m
};

}  // namespace anchord
