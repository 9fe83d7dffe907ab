#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "knowledge/knowledge.h"
#include "models/moving_intensity.h"
#include "models/somewhere.h"
#include "models/transition.h"
#include "models/undetected_intensity.h"

namespace anchord {

/// The knowledge, prepared for computing: what the engine derives from it once. Immutable.
struct Background {
  /// An attribute's transitions: a Markov chain over the symbols that take part, ascending.
  struct SymbolChain {
    std::vector<int> symbols;
    ModelMatrix rates;  ///< 1/s
  };

  /// How the behaviour models of a class follow each other.
  struct Dynamics {
    ModelMatrix rates;         ///< 1/s between models
    bool moves = false;        ///< any rate at all
    bool exchanges = false;    ///< between tracked models of unlike motion: densities are merged by
                               ///< moments, so two steps are not one long one
    int first_detectable = 0;  ///< the tracked model that a found object goes to
    std::vector<SymbolChain> changes;  ///< of attributes, as ObjectClass::changes
  };

  explicit Background(Knowledge knowledge);

  const Knowledge knowledge;
  int dims;
  std::vector<Dynamics> dynamics;  ///< per class
  Grid grid;                       ///< over the bounds
  std::shared_ptr<const Tiling> tiling;
  Walls walls;
  double largest_extent = 0;  ///< of any class, a diagonal, m; above 0: objects hide each other
  bool shares = false;        ///< some class has a model whose objects share detections
  bool has_phantoms = false;  ///< any class is one
  bool ranged = false;        ///< some sensor's p_D depends on the distance
  std::vector<std::shared_ptr<const ArrivalModel>> arrivals;  ///< per class
  /// Per class; empty where no class has any.
  std::vector<std::shared_ptr<const MovingArrivals>> moving_arrivals;
  double gate_distance2;    ///< squared Mahalanobis distance; infinite without gate
  double log_least_weight;  ///< ln of Limits::min_weight; minus infinity if 0
  /// A density further than so many standard deviations from all that is in view, along x or y, is
  /// not in view: less than Limits::min_weight of it would be, and never more than rounding.
  double sight_deviations;

  /// The footprint of a place; -1: of the world's bounds. Made for every place.
  const std::shared_ptr<const Footprint>& footprint(int place) const {
    return footprints_[place + 1];
  }
  /// The place that a footprint is of; -1: the world's bounds.
  int place_of(const Footprint& footprint) const;
  /// Footprint::overlap() of one of these footprints with a place (-1: the bounds).
  const CellShares& overlap(const Footprint& footprint, int place) const {
    return overlaps_.at(&footprint)[place + 1];
  }
  /// Per cell of one of these footprints the share that lies in any place.
  const CellShares& overlap_any(const Footprint& footprint) const {
    return overlaps_any_.at(&footprint);
  }
  /// The footprints that a behaviour model of some class goes to, each once.
  const std::vector<const Footprint*>& searched() const { return searched_; }
  /// A bit that stands for the place (or the bounds) of one of these footprints; where there are
  /// too many places, for others too.
  std::uint64_t bit_of(const Footprint& footprint) const { return bits_.at(&footprint); }
  /// The bits of all places with a part in a box of the plane: x_min, y_min, x_max, y_max.
  std::uint64_t places_in(const std::array<double, 4>& box) const;
  /// Whether outermost places are disjoint and every inner one lies in its parent.
  bool places_nest() const { return places_nest_; }
  /// The cell of a point, or -1 outside the bounds, where nothing is kept per cell.
  int cell_of(const Eigen::Vector3d& point) const {
    for (int i = 0; i < dims; ++i)
      if (point[i] < knowledge.bounds_min[i] || point[i] > knowledge.bounds_max[i]) return -1;
    return grid.index(point);
  }
  /// Of a cell's column, m^dims.
  double cell_volume() const {
    return grid.cell * grid.cell * (dims == 3 ? grid.z_max - grid.z_min : 1.0);
  }
  const ObjectClass& object_class(int c) const { return knowledge.classes[c]; }
  int classes() const { return static_cast<int>(knowledge.classes.size()); }

 private:
  std::vector<std::shared_ptr<const Footprint>> footprints_;
  std::map<const Footprint*, std::vector<CellShares>> overlaps_;
  std::map<const Footprint*, CellShares> overlaps_any_;
  std::vector<const Footprint*> searched_;
  std::map<const Footprint*, std::uint64_t> bits_;
  bool places_nest_ = true;

  void compare_places();
  void number_places();
};

}  // namespace anchord
