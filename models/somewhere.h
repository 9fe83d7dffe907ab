#pragma once

#include <Eigen/Core>
#include <boost/container/small_vector.hpp>
#include <memory>
#include <vector>

#include "core/pool.h"
#include "geometry/gaussian.h"
#include "geometry/grid.h"
#include "geometry/region.h"

namespace anchord {

/// The cells of a region, with the share of its area that lies in each: the support of `somewhere`
/// and what expected numbers in a place are summed over. Shared by all densities over that place.
struct Footprint {
  Region region;
  double volume = 0;  ///< m^dims
  int dims = 2;
  Grid grid;
  std::vector<int> cells;         ///< grid indices, ascending
  std::vector<double> share;      ///< of the region's area in each of them; sums to 1
  std::vector<int> position_of;   ///< by grid index: where in `cells` it stands, or -1
  std::vector<Region> piece;      ///< what of the region lies in each cell
  std::vector<Gaussian> moments;  ///< of each piece, in the plane

  /// The region must have a finite volume. The grid is that of the region's own bounding box,
  /// aligned to `world`.
  static Footprint of(const Region& region, const Grid& world, int dims);

  /// Per cell the share of what lies in the region that lies in another region too. Where neither
  /// polygon is convex, as if the region filled each of its cells.
  std::vector<double> overlap(const Region& other) const;

  /// Whether densities over one are densities over the other.
  bool same_cells(const Footprint& other) const {
    return region == other.region && dims == other.dims && grid == other.grid;
  }
};

/// A measurement as every density over one place has it.
struct MeasuredIn {
  double mass = 0;  ///< how much of it lies in the place
  /// The density convolved with the noise is, over the uniform one, `scale` times the mean of its
  /// relative heights over these cells (positions in the footprint); of no cells, 1.
  double scale = 0;
  struct Part {
    int cell;
    double share;  ///< of what lies in these cells
  };
  boost::container::small_vector<Part, 4> parts;

  /// In a 3-D world as if the noise in height were independent of the plane's. Where the noise is
  /// small against a cell and the mean is well inside, the mean's cell decides.
  static MeasuredIn of(const Gaussian& measurement, const Footprint& place);
};

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

  /// The density's mass in view; `visible` is per cell of the footprint the share in view.
  double mass(const std::vector<double>& visible) const;
  /// The density's mass in each of the footprint's cells, in order.
  double mass_in(int cell_position) const;

  /// Mass that enters is uniform: gamma <- (w gamma + dw U) / (w + dw). Weights >= 0, dw > 0.
  void enter(double weight, double entering);

  /// Differential entropy, nat: exact, the density is constant on pieces.
  double entropy() const;

  /// After a miss: the share p of the density in view goes, and the rest is normalised.
  void miss(double p, const std::vector<double>& visible);

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

 private:
  /// How much of the density is uniform.
  double uniform() const { return looked_at_ ? 1 - weight_looked_ : 1.0; }
  /// Density in a cell over the uniform one.
  double relative(std::size_t i) const {
    return looked_at_ ? weight_looked_ * (*looked_at_)[i] + uniform() : 1.0;
  }

  std::shared_ptr<const Footprint> footprint_;
  /// The density is weight_looked_ * looked_at_ + (1 - weight_looked_), over the uniform density.
  std::shared_ptr<const PoolVector<double>> looked_at_;
  double weight_looked_ = 0;
};

}  // namespace anchord
