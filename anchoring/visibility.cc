#include "anchoring/visibility.h"

#include <algorithm>
#include <numeric>

namespace anchord {
namespace {

Look look_at(const MapView& view, const Tiling& tiling) {
  Look look;
  if (view.sees_nothing()) return look;
  const Grid& grid = tiling.grid;
  const auto seen = view.bounds();
  for (int t = 0; t < tiling.tiles(); ++t) {
    const int x0 = t % tiling.columns * Tiling::kEdge, y0 = t / tiling.columns * Tiling::kEdge;
    const double edge = Tiling::kEdge * grid.cell;
    const double x = grid.origin.x() + x0 * grid.cell, y = grid.origin.y() + y0 * grid.cell;
    if (x > seen[2] || y > seen[3] || x + edge < seen[0] || y + edge < seen[1]) continue;
    Look::Tile tile{t, std::vector<double>(Tiling::kCells, 0.0)};
    bool any = false;
    for (int j = 0; j < Tiling::kEdge && y0 + j < grid.rows; ++j)
      for (int i = 0; i < Tiling::kEdge && x0 + i < grid.columns; ++i) {
        const int cell = (y0 + j) * grid.columns + x0 + i;
        const double share =
            view.sees_everything() ? 1.0 : view.share(grid.corner_min(cell), grid.corner_max(cell));
        tile.share[j * Tiling::kEdge + i] = share;
        any = any || share > 0;
      }
    if (any) look.tiles.push_back(std::move(tile));
  }
  return look;
}

double sum(const Look& look) {
  double shares = 0;
  for (const Look::Tile& tile : look.tiles)
    shares = std::accumulate(tile.share.begin(), tile.share.end(), shares);
  return shares;
}

}  // namespace

Visibility::Visibility(const MapView& view, const Background& background)
    : view_(view),
      background_(&background),
      look_(look_at(view, *background.tiling)),
      volume_(sum(look_) * background.cell_volume()) {}

const std::vector<double>& Visibility::of(const Footprint& footprint) const {
  auto it = footprints_.find(&footprint);
  if (it == footprints_.end()) it = footprints_.emplace(&footprint, footprint.visible(view_)).first;
  return it->second;
}

LeafVisibility Visibility::of(const Leaf& leaf, const std::vector<double>& p_detect) const {
  LeafVisibility shown;
  for (std::size_t c = 0; c < leaf.classes.size(); ++c) shown.p += leaf.classes[c] * p_detect[c];
  shown.v_model.assign(leaf.models.size(), 0.0);
  if (view_.sees_nothing() || leaf.held) return shown;
  const auto& models = background_->object_class(leaf.model_class).models;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    if (!models[m].detectable || leaf.models[m].weight <= 0) continue;
    const auto& density = leaf.models[m].density;
    const double mass =
        std::holds_alternative<Kinematic>(density)
            ? view_.mass(std::get<Kinematic>(density).position_density())
            : std::get<Somewhere>(density).mass(of(*std::get<Somewhere>(density).footprint()));
    shown.v_model[m] = mass;
    shown.v += leaf.models[m].weight * mass;
  }
  shown.v = std::min(shown.v, 1.0);
  return shown;
}

}  // namespace anchord
