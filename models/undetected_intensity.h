#pragma once

#include <memory>
#include <vector>

#include "core/pool.h"
#include "geometry/grid.h"

namespace anchord {

/// Cells of a grid in square blocks: what a look at the world touches, and copies, at once.
struct Tiling {
  static constexpr int kEdge = 16;
  static constexpr int kCells = kEdge * kEdge;
  Grid grid;
  int columns = 0, rows = 0;  ///< of tiles

  explicit Tiling(const Grid& grid);
  int tiles() const { return columns * rows; }
  int tile_of(int cell) const;
  int place_in_tile(int cell) const;
  int cell(int tile, int place) const;  ///< of the grid, or beyond it
};

/// The visible share of each cell, for the tiles where there is any.
struct Look {
  struct Tile {
    int tile;
    std::vector<double> share;  ///< Tiling::kCells entries, cells beyond the grid 0
  };
  std::vector<Tile> tiles;  ///< by number, ascending

  /// Of a cell of the grid.
  double at(const Tiling& tiling, int cell) const;
};

/// What drives a class's intensity: d lambda / dt = beta(x) - mu lambda.
struct ArrivalModel {
  double start = 0;                           ///< lambda at the start, per m^dims
  double departure_rate = 0;                  ///< mu, 1/s
  double arrival_rate = 0;                    ///< beta, per m^dims and s, everywhere
  std::vector<double> arrival_rate_per_cell;  ///< if not empty: beta of each grid cell instead
  bool operator==(const ArrivalModel&) const = default;
};

/// The expected number, per m^dims, of objects of one class that exist and have never been
/// detected, on a grid. Cells that no look has touched follow from the start value alone and take
/// no memory. Outside the grid it stays at its start value. Time in seconds since the start of all;
/// that of a class that came later begins with `since`. A value: copies share their tiles.
class UndetectedIntensity {
 public:
  UndetectedIntensity(std::shared_ptr<const Tiling> tiling,
                      std::shared_ptr<const ArrivalModel> model, double since = 0)
      : tiling_(std::move(tiling)),
        model_(std::move(model)),
        tiles_(tiling_->tiles()),
        since_(since) {}

  /// lambda in a cell (-1: outside the grid) at `time` (s, not before the last look).
  double at(int cell, double time) const;

  /// A sensor that detects with probability p looked and saw nothing new:
  /// lambda <- (1 - p share) lambda. Returns the sum over the cells of share lambda as it was
  /// before, per m^dims: times p and a cell's volume, how many detections were expected.
  double miss(const Look& look, double p, double time);

  /// The same belief on another grid, or with other arrivals from `time` on (s, not before the last
  /// look). Cells that a look has touched keep what is expected there at that time, taken at the
  /// middle of each new cell; the others follow from the new start value and arrivals alone, as if
  /// these had held all along. Where nothing differs it is the same to the bit.
  UndetectedIntensity continued(std::shared_ptr<const Tiling> tiling,
                                std::shared_ptr<const ArrivalModel> model, double time) const;

  /// What changes of it; grid and arrivals do not.
  template <typename Archive>
  void serialize(Archive& archive) {
    archive(tiles_);
  }
  /// What was not held by checkpoints of version 1.
  template <typename Archive>
  void serialize_since(Archive& archive) {
    archive(since_);
  }

 private:
  struct Tile {
    double time = 0;
    PoolVector<double> intensity;
    template <typename Archive>
    void serialize(Archive& archive) {
      archive(time, intensity);
    }
  };
  double untouched(int cell, double time) const;
  double arrival_rate(int cell) const {
    return model_->arrival_rate_per_cell.empty() ? model_->arrival_rate
                                                 : model_->arrival_rate_per_cell[cell];
  }

  std::shared_ptr<const Tiling> tiling_;
  std::shared_ptr<const ArrivalModel> model_;
  std::vector<std::shared_ptr<const Tile>> tiles_;
  double since_ = 0;  ///< s; when untouched cells had their start value
};

}  // namespace anchord
