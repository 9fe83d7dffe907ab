#include "models/footprint.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "geometry/gaussian_mass.h"
#include "geometry/polygon.h"

namespace anchord {

Footprint Footprint::of(const Region& region, const Grid& world, int dims) {
  Footprint f;
  f.region = region;
  f.volume = region.volume(dims);
  f.dims = dims;
  Eigen::Vector3d low(region.polygon[0].x(), region.polygon[0].y(), 0), high = low;
  for (const auto& p : region.polygon) {
    low.head<2>() = low.head<2>().cwiseMin(p);
    high.head<2>() = high.head<2>().cwiseMax(p);
  }
  for (int axis = 0; axis < 2; ++axis) {
    const double steps = (low[axis] - world.origin[axis]) / world.cell;
    low[axis] = world.origin[axis] + std::floor(steps + 1e-9) * world.cell;
  }
  if (dims == 3) low.z() = region.z_min, high.z() = region.z_max;
  f.grid = Grid::over(low, high, world.cell);
  f.position_of.assign(f.grid.size(), -1);
  const double area = region.area();
  const auto add = [&](int cell) {
    Polygon part = part_in(region.polygon, f.grid.corner_min(cell), f.grid.corner_max(cell));
    const double share = area_of(part) / area;
    if (share <= 0) return;
    f.position_of[cell] = static_cast<int>(f.cells.size());
    f.cells.push_back(cell);
    f.share.push_back(share);
    f.moments.push_back(moments_of(part));
    f.piece.push_back({std::move(part), region.z_min, region.z_max});
  };
  for (int y = 0; y < f.grid.rows; y += kBlockEdge)
    for (int x = 0; x < f.grid.columns; x += kBlockEdge) {
      const std::size_t first = f.cells.size();
      for (int j = y; j < std::min(y + kBlockEdge, f.grid.rows); ++j)
        for (int i = x; i < std::min(x + kBlockEdge, f.grid.columns); ++i)
          add(j * f.grid.columns + i);
      if (f.cells.size() == first) continue;
      f.block_of.resize(f.cells.size(), f.blocks());
      f.first_of.push_back(static_cast<int>(first));
      f.block_share.push_back(std::accumulate(f.share.begin() + static_cast<std::ptrdiff_t>(first),
                                              f.share.end(), 0.0));
    }
  f.first_of.push_back(static_cast<int>(f.cells.size()));
  return f;
}

std::vector<double> Footprint::overlap(const Region& other) const {
  std::vector<double> out(cells.size(), 0.0);
  double height = 1;
  if (dims == 3) {
    const double low = std::max(region.z_min, other.z_min);
    const double high = std::min(region.z_max, other.z_max);
    height = std::max(0.0, high - low) / (region.z_max - region.z_min);
  }
  if (height == 0) return out;
  const auto common = region.polygon == other.polygon ? std::optional(region.polygon)
                                                      : common_part(region.polygon, other.polygon);
  const double area = region.area();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Eigen::Vector3d low = grid.corner_min(cells[i]), high = grid.corner_max(cells[i]);
    const double part = common
                            ? area_of(part_in(*common, low, high)) / (share[i] * area)
                            : area_of(part_in(other.polygon, low, high)) / (grid.cell * grid.cell);
    out[i] = height * std::min(part, 1.0);
  }
  return out;
}

CellShares::CellShares(std::vector<double> shares, const Footprint& footprint)
    : shares_(std::move(shares)),
      total_(std::inner_product(shares_.begin(), shares_.end(), footprint.share.begin(), 0.0)) {
  for (int b = 0; b < footprint.blocks(); ++b)
    if (std::any_of(shares_.begin() + footprint.first_of[b],
                    shares_.begin() + footprint.first_of[b + 1], [](double x) { return x > 0; }))
      blocks_.push_back(b);
}

MeasuredIn MeasuredIn::of(const Gaussian& z, const Footprint& place) {
  MeasuredIn out;
  out.mass = out.scale = ::anchord::mass(z, place.region, place.dims);
  if (out.mass <= 0) return out;
  const double spread2 = std::max(z.covariance(0, 0), z.covariance(1, 1));
  const Grid& grid = place.grid;
  if (spread2 * 16 < grid.cell * grid.cell && out.mass > 0.999) {
    out.scale = place.region.contains(z.mean, place.dims) ? 1 : 0;
    const int cell = grid.index(z.mean);
    if (const int i = cell < 0 ? -1 : place.position_of[cell]; i >= 0) out.parts.push_back({i, 1});
    return out;
  }
  // The mean of the density's relative height over the cells around z, weighted by what of z's
  // distribution in the plane lies in each.
  constexpr double kReach = 6;  // standard deviations; 1e-8 of the mass is farther
  const double reach = kReach * std::sqrt(spread2);
  const auto column = [&](double x) {
    return std::clamp(static_cast<int>(std::floor((x - grid.origin.x()) / grid.cell)), 0,
                      grid.columns - 1);
  };
  const auto row = [&](double y) {
    return std::clamp(static_cast<int>(std::floor((y - grid.origin.y()) / grid.cell)), 0,
                      grid.rows - 1);
  };
  double sum = 0;
  for (int r = row(z.mean.y() - reach); r <= row(z.mean.y() + reach); ++r)
    for (int c = column(z.mean.x() - reach); c <= column(z.mean.x() + reach); ++c) {
      const int i = place.position_of[r * grid.columns + c];
      if (i < 0) continue;
      const double m = ::anchord::mass(z, place.piece[i], 2);
      if (m > 0) out.parts.push_back({i, m});
      sum += m;
    }
  for (Part& part : out.parts) part.share /= sum;
  return out;
}

}  // namespace anchord
