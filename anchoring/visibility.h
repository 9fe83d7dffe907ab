#pragma once

#include <map>
#include <memory>
#include <vector>

#include "anchoring/leaf.h"
#include "geometry/view.h"

namespace anchord {

/// What one view shows of the world: computed once per view, and kept while the view stays.
class Visibility {
 public:
  Visibility(const MapView& view, const Background& background);

  const MapView& view() const { return view_; }

  /// What the view means for a predicted leaf.
  LeafVisibility of(const Leaf& leaf, const std::vector<double>& detection_probability) const;

  /// Per cell of a footprint the share in view; the footprint is one of the Background's.
  const std::vector<double>& of(const Footprint& footprint) const;

  /// Per cell of the world's grid the share in view.
  const Look& look() const { return look_; }

  /// How much of the world is in view, m^dims.
  double volume() const { return volume_; }

 private:
  MapView view_;
  const Background* background_;
  Look look_;
  double volume_;
  mutable std::map<const Footprint*, std::vector<double>> footprints_;  // filled when asked for
};

}  // namespace anchord
