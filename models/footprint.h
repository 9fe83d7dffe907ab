#pragma once

#include <Eigen/Core>
#include <boost/container/small_vector.hpp>
#include <vector>

#include "geometry/gaussian.h"
#include "geometry/grid.h"
#include "geometry/region.h"

namespace anchord {

/// The cells of a region, with the share of its area that lies in each: the support of `somewhere`
/// and what expected numbers in a place are summed over. Shared by all densities over that place.
/// Cells stand block by block: squares of the grid, which a look touches or does not.
struct Footprint {
  static constexpr int kBlockEdge = 8;  ///< cells

  Region region;
  double volume = 0;  ///< m^dims
  int dims = 2;
  Grid grid;
  std::vector<int> cells;           ///< grid indices, block by block, ascending in each
  std::vector<double> share;        ///< of the region's area in each of them; sums to 1
  std::vector<int> position_of;     ///< by grid index: where in `cells` it stands, or -1
  std::vector<Region> piece;        ///< what of the region lies in each cell
  std::vector<Gaussian> moments;    ///< of each piece, in the plane
  std::vector<int> first_of;        ///< by block: its first cell; then the number of cells
  std::vector<int> block_of;        ///< by cell
  std::vector<double> block_share;  ///< of the region's area, by block

  /// The region must have a finite volume. The grid is that of the region's own bounding box,
  /// aligned to `world`.
  static Footprint of(const Region& region, const Grid& world, int dims);

  int blocks() const { return static_cast<int>(block_share.size()); }

  /// Per cell the share of what lies in the region that lies in another region too. Where neither
  /// polygon is convex, as if the region filled each of its cells.
  std::vector<double> overlap(const Region& other) const;

  /// Whether densities over one are densities over the other.
  bool same_cells(const Footprint& other) const {
    return region == other.region && dims == other.dims && grid == other.grid;
  }
};

/// Per cell of a footprint a share, 0 to 1: what of it is in view, or in another place.
class CellShares {
 public:
  CellShares() = default;
  CellShares(std::vector<double> shares, const Footprint& footprint);

  double operator[](std::size_t cell) const { return shares_[cell]; }
  std::size_t size() const { return shares_.size(); }
  const double* data() const { return shares_.data(); }
  /// Of all of the footprint's area.
  double total() const { return total_; }
  /// The blocks of cells in which any share is above 0, ascending.
  const std::vector<int>& blocks() const { return blocks_; }

 private:
  std::vector<double> shares_;
  std::vector<int> blocks_;
  double total_ = 0;
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

}  // namespace anchord
