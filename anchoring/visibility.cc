#include "anchoring/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/standard_normal.h"

namespace anchord {
namespace {

/// The share of a box that no wall hides: of points spread evenly, four to a column's height.
double clear_share(const Walls& walls, const Eigen::Vector3d& eye, const Eigen::Vector3d& low,
                   const Eigen::Vector3d& high, int dims) {
  const std::size_t up = dims == 3 ? 4 : 1;
  const Eigen::Vector3d size = high - low;
  std::array<double, 4> heights;
  for (std::size_t k = 0; k < up; ++k)
    heights[k] = low.z() + (static_cast<double>(k) + 0.5) / static_cast<double>(up) * size.z();
  int clear = 0;
  for (const double i : {0.25, 0.75})
    for (const double j : {0.25, 0.75})
      clear +=
          walls.clear(eye, {low.x() + i * size.x(), low.y() + j * size.y()}, {heights.data(), up});
  return clear / (4 * static_cast<double>(up));
}

/// The walls that may hide something in view from an eye.
Walls walls_before(const MapView& view, const std::optional<Eigen::Vector3d>& eye,
                   const Background& background) {
  if (!eye) return Walls({});
  const auto seen = view.bounds();
  return background.walls.within({std::min(seen[0], eye->x()), std::min(seen[1], eye->y()),
                                  std::max(seen[2], eye->x()), std::max(seen[3], eye->y())});
}

/// The share of a box that is in view and that no wall hides.
double share_in_view(const MapView& view, const std::optional<Eigen::Vector3d>& eye,
                     const Walls& walls, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     int dims) {
  const double share = view.share(low, high);
  return eye && share > 0 ? share * clear_share(walls, *eye, low, high, dims) : share;
}

Look look_at(const MapView& view, const std::optional<Eigen::Vector3d>& eye, const Walls& walls,
             const Background& background) {
  const Tiling& tiling = *background.tiling;
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
        const double share = share_in_view(view, eye, walls, grid.corner_min(cell),
                                           grid.corner_max(cell), background.dims);
        tile.share[j * Tiling::kEdge + i] = share;
        any = any || share > 0;
      }
    if (any) look.tiles.push_back(std::move(tile));
  }
  return look;
}

/// What a miss may move at the most without being told: of what a version needs to be kept. The
/// same part of a density that moves so little is not missed twice, so that it does not add up.
constexpr double kHardly = 0.025;

/// A point about the mean of a density, in white coordinates, and how much it counts.
struct Probe {
  Eigen::Vector3d white;
  double weight;
};

/// Around the density in `dims` dimensions, near it and further out.
std::vector<Probe> probes(int dims) {
  std::vector<Probe> out;
  constexpr int kAround = 8;
  const int levels = dims == 3 ? 1 : 0;
  for (const double radius : {1.0, 2.3})
    for (int level = -levels; level <= levels; ++level)
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2 * std::numbers::pi * i / kAround;
        const Eigen::Vector3d at(std::cos(angle), std::sin(angle), level);
        out.push_back({radius * at.normalized(), std::exp(-radius * radius / 2)});
      }
  return out;
}

double sum(const Look& look) {
  double shares = 0;
  for (const Look::Tile& tile : look.tiles)
    shares = std::accumulate(tile.share.begin(), tile.share.end(), shares);
  return shares;
}

}  // namespace

Visibility::Visibility(const MapFrame& frame, const Background& background)
    : viewer_(frame.viewer),
      view_(frame.view),
      eye_(background.walls.none() ? std::nullopt : frame.eye),
      from_(background.ranged ? frame.eye : std::nullopt),
      background_(&background),
      walls_(walls_before(view_, eye_, background)),
      look_(look_at(view_, eye_, walls_, background)),
      volume_(sum(look_) * background.cell_volume()),
      hardly_(kHardly * background.knowledge.limits.min_existence) {}

bool Visibility::same_for(const MapFrame& frame) const {
  return view_ == frame.view && (background_->walls.none() || eye_ == frame.eye) &&
         (!background_->ranged || from_ == frame.eye);
}

const CellShares& Visibility::of(const Footprint& footprint) const {
  const auto [at, fresh] = footprints_.try_emplace(&footprint);
  if (fresh) at->second = {shares_of(footprint), footprint};
  return at->second;
}

std::vector<double> Visibility::shares_of(const Footprint& footprint) const {
  std::vector<double> share(footprint.cells.size(), 0.0);
  if (view_.sees_nothing()) return share;
  const Grid &world = background_->grid, &grid = footprint.grid;
  const bool columns = grid.z_min == world.z_min && grid.z_max == world.z_max;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const Eigen::Vector3d low = grid.corner_min(footprint.cells[i]);
    const Eigen::Vector3d high = grid.corner_max(footprint.cells[i]);
    const int column = columns ? world.index(0.5 * (low + high)) : -1;
    share[i] = column >= 0 ? look_.at(*background_->tiling, column) : share_of(low, high);
  }
  return share;
}

double Visibility::share_of(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
  return share_in_view(view_, eye_, walls_, low, high, background_->dims);
}

double Visibility::clear_of_walls(const Gaussian& density) const {
  // Points of equal probability: most of them across the line of sight, where walls end.
  static constexpr std::array<double, 7> kAcross{-1.4652337927, -0.7916386078, -0.3661063568, 0,
                                                 0.3661063568,  0.7916386078,  1.4652337927};
  static constexpr std::array<double, 3> kElse{-0.9674215661, 0, 0.9674215661};
  const Eigen::Vector3d towards = density.mean - *eye_;
  const double bearing = std::atan2(towards.y(), towards.x());
  Eigen::Matrix3d axes;  // upward, along, across
  axes << 0, std::cos(bearing), -std::sin(bearing), 0, std::sin(bearing), std::cos(bearing), 1, 0,
      0;
  const Eigen::Matrix3d factor =
      axes * upper_factor<3>(axes.transpose() * density.covariance * axes);
  const std::size_t up = background_->dims == 3 ? kElse.size() : 1;
  int in_view = 0, clear = 0, clear_at_all = 0;
  for (const double across : kAcross)
    for (const double along : kElse)
      for (std::size_t k = 0; k < up; ++k) {
        const double upward = up > 1 ? kElse[k] : 0;
        const Eigen::Vector3d at = density.mean + factor * Eigen::Vector3d(upward, along, across);
        const bool unhidden = !background_->walls.hide(*eye_, at);
        clear_at_all += unhidden;
        if (!view_.contains(at)) continue;
        ++in_view;
        clear += unhidden;
      }
  if (in_view > 0) return static_cast<double>(clear) / in_view;
  return clear_at_all / static_cast<double>(kAcross.size() * kElse.size() * up);
}

/// How exactly the mass in view must be known of what is there with probability p <= 1/2, so that a
/// miss moves no probability by more than a tenth of what a version needs to be kept: by at most
/// 4 p times the mass's error. What is likelier is taken as exactly as can be.
double Visibility::exactness(double p) const {
  return p > 0.5 ? 0 : 0.1 * background_->knowledge.limits.min_existence / (4 * p);
}

bool Visibility::out_of_view(const Kinematic& density) const {
  const auto seen = view_.bounds();
  for (int i = 0; i < 2; ++i) {
    const double reach = background_->sight_deviations * std::sqrt(density.pp(i, i));
    if (density.position[i] + reach < seen[i] || density.position[i] - reach > seen[i + 2])
      return true;
  }
  return false;
}

SeenPart Visibility::aimed(SeenPart part, const Kinematic& kinematic) const {
  static const std::vector<Probe> kFlat = probes(2), kSolid = probes(3);
  if (!SeenShare::cuts(part.v)) return part;
  const Eigen::Matrix3d factor = upper_factor<3>(kinematic.pp);
  Eigen::Vector3d inward = Eigen::Vector3d::Zero();
  for (const Probe& probe : background_->dims == 3 ? kSolid : kFlat) {
    const Eigen::Vector3d at = kinematic.position + factor * probe.white;
    const bool seen = view_.contains(at) && !(eye_ && walls_.hide(*eye_, at));
    inward += (seen ? probe.weight : -probe.weight) * probe.white;
  }
  const double length = inward.norm();
  if (length > 1e-9)  // else it does not reach in from one side
    part.toward = factor.transpose().triangularView<Eigen::Lower>().solve(inward / length);
  return part;
}

SeenPart Visibility::part(const Kinematic& kinematic, double p, const Occlusion& occlusion,
                          std::uint64_t birth) const {
  if (out_of_view(kinematic)) return {};
  const Gaussian density = kinematic.position_density();
  double mass = view_.mass(density, exactness(p));
  if (mass > 0 && eye_) mass *= clear_of_walls(density);
  if (mass > 0 && !occlusion.none()) mass *= occlusion.clear(density, birth);
  SeenPart part{std::min(mass, 1.0), viewer_};
  if (SeenShare::cuts(part.v)) part.variance = variance_of(kinematic, background_->dims);
  return part;
}

void Visibility::find(Leaf& leaf, const Occlusion& occlusion, std::uint64_t birth) const {
  for (ModelState& state : leaf.models)
    if (const auto* kinematic = std::get_if<Kinematic>(&state.density);
        kinematic && state.weight > 0)
      state.seen.find(
          aimed(part(*kinematic, leaf.existence * state.weight, occlusion, birth), *kinematic));
}

const Look& Visibility::look(const DetectionProbability& p) const {
  const auto [at, fresh] = looks_.try_emplace({p.near, p.per_m}, look_);
  if (!fresh) return at->second;
  const Tiling& tiling = *background_->tiling;
  for (Look::Tile& tile : at->second.tiles)
    for (int i = 0; i < Tiling::kCells; ++i)
      if (double& share = tile.share[i]; share > 0)
        share *= p.at(range_of(tiling.grid, tiling.cell(tile.tile, i)));
  return at->second;
}

double Visibility::range_of(const Grid& grid, int cell) const {
  if (!from_) return 0;
  const Eigen::Vector3d low = grid.corner_min(cell), high = grid.corner_max(cell);
  Eigen::Vector3d centre = 0.5 * (low + high);
  centre.z() = background_->dims == 3 ? std::clamp(from_->z(), low.z(), high.z()) : 0;
  return range(centre);
}

/// Of a place, how far what is in view of it is on average.
double Visibility::range(const Somewhere& somewhere) const {
  const Footprint& footprint = *somewhere.footprint();
  const auto [at, fresh] = ranges_.try_emplace(&footprint, 0);
  if (!fresh || !from_) return at->second;
  const CellShares& visible = of(footprint);
  double sum = 0, seen = 0;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const double area = visible[i] * footprint.share[i];
    if (area <= 0) continue;
    sum += area * range_of(footprint.grid, footprint.cells[i]);
    seen += area;
  }
  if (seen > 0) at->second = sum / seen;
  return at->second;
}

LeafVisibility Visibility::of(const Leaf& leaf, const Sensor& sensor, const Occlusion& occlusion,
                              std::uint64_t birth) const {
  LeafVisibility shown;
  const auto& p = sensor.detection_probability;
  for (std::size_t c = 0; c < leaf.classes.size(); ++c) shown.p += leaf.classes[c] * p[c].near;
  shown.parts.resize(leaf.models.size());
  shown.v_model.assign(leaf.models.size(), 0.0);
  shown.factor.assign(leaf.models.size(), 1.0);
  if (view_.sees_nothing() || leaf.held) return shown;
  const auto& models = background_->object_class(leaf.model_class).models;
  if (from_) shown.ranged.assign(leaf.models.size(), {});
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    const ModelState& state = leaf.models[m];
    if (!models[m].detectable || state.weight <= 0) continue;
    double& v = shown.v_model[m];
    if (const auto* kinematic = std::get_if<Kinematic>(&state.density)) {
      shown.parts[m] = part(*kinematic, leaf.existence * state.weight, occlusion, birth);
      shown.factor[m] = state.seen.factor(shown.parts[m]);
      v = shown.factor[m] * shown.parts[m].v;
      if (v * leaf.existence * state.weight < hardly_) v = 0;
    } else {
      const auto& somewhere = std::get<Somewhere>(state.density);
      v = somewhere.mass(of(*somewhere.footprint()));
    }
    shown.v += state.weight * v;
  }
  shown.v = std::min(shown.v, 1.0);
  if (shown.ranged.empty()) return shown;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    if (shown.v_model[m] <= 0) continue;
    const auto* kinematic = std::get_if<Kinematic>(&leaf.models[m].density);
    const double away =
        kinematic ? range(kinematic->position) : range(std::get<Somewhere>(leaf.models[m].density));
    shown.ranged[m] = {away, 0};
    for (std::size_t c = 0; c < leaf.classes.size(); ++c)
      shown.ranged[m].p += leaf.classes[c] * p[c].at(away);
  }
  shown.average(leaf);
  return shown;
}

}  // namespace anchord
