#include "models/undetected_intensity.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace anchord {
namespace {

/// A row of a tile.
using Row = Eigen::Map<Eigen::ArrayXd>;
using ConstRow = Eigen::Map<const Eigen::ArrayXd>;

/// Integral of exp(-mu s) over s in [0, dt].
double arrived(double mu, double dt) { return mu > 0 ? -std::expm1(-mu * dt) / mu : dt; }

}  // namespace

Tiling::Tiling(const Grid& g)
    : grid(g), columns((g.columns + kEdge - 1) / kEdge), rows((g.rows + kEdge - 1) / kEdge) {}

int Tiling::tile_of(int cell) const {
  const int x = cell % grid.columns, y = cell / grid.columns;
  return y / kEdge * columns + x / kEdge;
}

int Tiling::place_in_tile(int cell) const {
  const int x = cell % grid.columns, y = cell / grid.columns;
  return y % kEdge * kEdge + x % kEdge;
}

int Tiling::cell(int tile, int place) const {
  const int x = tile % columns * kEdge + place % kEdge, y = tile / columns * kEdge + place / kEdge;
  return y * grid.columns + x;
}

double Look::at(const Tiling& tiling, int cell) const {
  const int number = tiling.tile_of(cell);
  const auto tile = std::ranges::lower_bound(tiles, number, {}, &Tile::tile);
  if (tile == tiles.end() || tile->tile != number) return 0;
  return tile->share[tiling.place_in_tile(cell)];
}

double UndetectedIntensity::untouched(int cell, double time) const {
  const double mu = model_->departure_rate;
  const double dt = time - since_;
  return model_->start * std::exp(-mu * dt) + arrival_rate(cell) * arrived(mu, dt);
}

double UndetectedIntensity::at(int cell, double time) const {
  if (cell < 0) return model_->start;
  const auto& tile = tiles_[tiling_->tile_of(cell)];
  if (!tile) return untouched(cell, time);
  const double mu = model_->departure_rate, dt = time - tile->time;
  return tile->intensity[tiling_->place_in_tile(cell)] * std::exp(-mu * dt) +
         arrival_rate(cell) * arrived(mu, dt);
}

UndetectedIntensity UndetectedIntensity::continued(std::shared_ptr<const Tiling> tiling,
                                                   std::shared_ptr<const ArrivalModel> model,
                                                   double time) const {
  UndetectedIntensity out(std::move(tiling), std::move(model), since_);
  const Grid &from = tiling_->grid, &to = out.tiling_->grid;
  if (from == to && *model_ == *out.model_) {
    out.tiles_ = tiles_;
    return out;
  }
  for (int t = 0; t < out.tiling_->tiles(); ++t) {
    auto next = make_pooled<Tile>();
    next->time = time;
    next->intensity.assign(Tiling::kCells, 0.0);
    bool touched = false;
    const int x0 = t % out.tiling_->columns * Tiling::kEdge;
    const int y0 = t / out.tiling_->columns * Tiling::kEdge;
    for (int y = y0; y < std::min(y0 + Tiling::kEdge, to.rows); ++y)
      for (int x = x0; x < std::min(x0 + Tiling::kEdge, to.columns); ++x) {
        const int cell = y * to.columns + x;
        const int before = from.index(0.5 * (to.corner_min(cell) + to.corner_max(cell)));
        const bool looked_at = before >= 0 && tiles_[tiling_->tile_of(before)];
        touched = touched || looked_at;
        next->intensity[out.tiling_->place_in_tile(cell)] =
            looked_at ? at(before, time) : out.untouched(cell, time);
      }
    if (touched) out.tiles_[t] = std::move(next);
  }
  return out;
}

double UndetectedIntensity::miss(const Look& look, double p, double time) {
  if (p <= 0) return 0;
  double seen_intensity = 0;
  const Grid& grid = tiling_->grid;
  const double mu = model_->departure_rate;
  for (const Look::Tile& seen : look.tiles) {
    const std::shared_ptr<const Tile>& old = tiles_[seen.tile];
    const double dt = time - (old ? old->time : since_);
    const double stay = std::exp(-mu * dt), rise = arrived(mu, dt);
    const int x0 = seen.tile % tiling_->columns * Tiling::kEdge;
    const int y0 = seen.tile / tiling_->columns * Tiling::kEdge;
    auto next = make_pooled<Tile>();
    next->time = time;
    next->intensity.resize(Tiling::kCells);
    const int width = std::min(Tiling::kEdge, grid.columns - x0);
    for (int y = 0; y < Tiling::kEdge && y0 + y < grid.rows; ++y) {
      const int first = y * Tiling::kEdge, cell = (y0 + y) * grid.columns + x0;
      Row now(next->intensity.data() + first, width);
      if (old)
        now = stay * ConstRow(old->intensity.data() + first, width);
      else
        now = stay * model_->start;
      if (model_->arrival_rate_per_cell.empty())
        now += rise * model_->arrival_rate;
      else
        now += rise * ConstRow(model_->arrival_rate_per_cell.data() + cell, width);
      const ConstRow share(seen.share.data() + first, width);
      seen_intensity += (now * share).sum();
      now *= 1 - p * share;
    }
    tiles_[seen.tile] = std::move(next);
  }
  return seen_intensity;
}

}  // namespace anchord
