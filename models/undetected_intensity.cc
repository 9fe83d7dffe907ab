#include "models/undetected_intensity.h"

#include <cmath>

namespace anchord {
namespace {

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

double UndetectedIntensity::untouched(int cell, double time) const {
  const double mu = model_->departure_rate;
  return model_->start * std::exp(-mu * time) + arrival_rate(cell) * arrived(mu, time);
}

double UndetectedIntensity::at(int cell, double time) const {
  if (cell < 0) return model_->start;
  const auto& tile = tiles_[tiling_->tile_of(cell)];
  if (!tile) return untouched(cell, time);
  const double mu = model_->departure_rate, dt = time - tile->time;
  return tile->intensity[tiling_->place_in_tile(cell)] * std::exp(-mu * dt) +
         arrival_rate(cell) * arrived(mu, dt);
}

double UndetectedIntensity::miss(const Look& look, double p, double time) {
  if (p <= 0) return 0;
  double seen_intensity = 0;
  const Grid& grid = tiling_->grid;
  const double mu = model_->departure_rate;
  for (const Look::Tile& seen : look.tiles) {
    const std::shared_ptr<const Tile>& old = tiles_[seen.tile];
    const double dt = old ? time - old->time : time;
    const double stay = std::exp(-mu * dt), rise = arrived(mu, dt);
    const int x0 = seen.tile % tiling_->columns * Tiling::kEdge;
    const int y0 = seen.tile / tiling_->columns * Tiling::kEdge;
    auto next = std::make_shared<Tile>();
    next->time = time;
    next->intensity.resize(Tiling::kCells);
    for (int y = 0; y < Tiling::kEdge && y0 + y < grid.rows; ++y)
      for (int x = 0; x < Tiling::kEdge && x0 + x < grid.columns; ++x) {
        const int i = y * Tiling::kEdge + x, cell = (y0 + y) * grid.columns + x0 + x;
        const double before = old ? old->intensity[i] : model_->start;
        const double now = before * stay + arrival_rate(cell) * rise;
        seen_intensity += now * seen.share[i];
        next->intensity[i] = now * (1 - p * seen.share[i]);
      }
    tiles_[seen.tile] = std::move(next);
  }
  return seen_intensity;
}

}  // namespace anchord
