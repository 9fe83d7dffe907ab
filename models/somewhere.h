#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <vector>

#include "models/relative_heights.h"

namespace anchord {

/// A density over a place that says: it is there somewhere. Uniform at first; where a sensor looked
/// and saw nothing it becomes less. Piecewise constant on the footprint's cells. A value.
class Somewhere {
 public:
  explicit Somewhere(std::shared_ptr<const Footprint> footprint)
      : footprint_(std::move(footprint)) {}

  const std::shared_ptr<const Footprint>& footprint() const { return footprint_; }

  /// The density at a point, per m^dims; 0 outside the place.
  double density(const Eigen::Vector3d& point) const;

  /// The density convolved with a measurement's noise, at its mean; see MeasuredIn.
  double likelihood(const Gaussian& measurement) const;
  /// The same of what has been taken down for the place once, for all densities over it.
  double likelihood(const MeasuredIn& measurement) const;

  /// The density's mass in what of the footprint's cells is in view, or in some place.
  double mass(const CellShares& shares) const;
  /// The density's mass in each of the footprint's cells, in order.
  double mass_in(int cell_position) const;

  /// Mass that enters is uniform: gamma <- (w gamma + dw U) / (w + dw). Weights >= 0, dw > 0.
  void enter(double weight, double entering);

  /// Time in which it went to another spot of the place so many times, on average: what a look has
  /// told fades. gamma <- e^-times gamma + (1 - e^-times) U; times >= 0.
  void stir(double times) { enter(std::exp(-times), -std::expm1(-times)); }

  /// Differential entropy, nat: exact, the density is constant on pieces.
  double entropy() const;

  /// After a miss: the share p of the density in view goes, and the rest is normalised.
  void miss(double p, const CellShares& visible);

  /// The mixture of two densities over the same place; weights > 0, any sum.
  static Somewhere merge(double weight_a, const Somewhere& a, double weight_b, const Somewhere& b);

  /// The same belief over a place that has changed. Where the cells are the same ones, the same
  /// density. Else its height, relative to that of the uniform one, in the middle of what each new
  /// cell has of the place, normalised; where the place was not before, 1, as nobody looked there.
  Somewhere over(std::shared_ptr<const Footprint> place) const;

  /// Mean and covariance of the position.
  Gaussian moments() const;

  /// What changes of it; the place does not.
  template <typename Archive>
  void serialize(Archive& archive) {
    archive(looked_at_, weight_looked_);
  }
  /// As it was held by checkpoints of versions 1 and 2: heights by cell, in the order of the grid.
  template <typename Archive>
  void load_by_cell(Archive& archive) {
    std::shared_ptr<const PoolVector<double>> heights;
    archive(heights, weight_looked_);
    if (heights) set_in_grid_order(*heights);
  }
  /// Whether what was read is a density over the footprint.
  bool fits() const { return !looked_at_ || looked_at_->fits(*footprint_); }

 private:
  /// How much of the density is uniform.
  double uniform() const { return looked_at_ ? 1 - weight_looked_ : 1.0; }
  /// Density in a cell over the uniform one.
  double relative(std::size_t i) const {
    return looked_at_
               ? weight_looked_ * looked_at_->at(static_cast<int>(i), *footprint_) + uniform()
               : 1.0;
  }
  /// All of the density as heights, to be changed.
  std::shared_ptr<RelativeHeights> heights() const;
  void set_in_grid_order(const PoolVector<double>& heights);

  std::shared_ptr<const Footprint> footprint_;
  /// The density is weight_looked_ * looked_at_ + (1 - weight_looked_), over the uniform density.
  std::shared_ptr<const RelativeHeights> looked_at_;
  double weight_looked_ = 0;
};

}  // namespace anchord
