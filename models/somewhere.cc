#include "models/somewhere.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/gaussian_mass.h"
#include "geometry/polygon.h"

namespace anchord {
namespace {

using Cells = Eigen::Map<Eigen::ArrayXd>;
using ConstCells = Eigen::Map<const Eigen::ArrayXd>;

template <typename Vector>
ConstCells cells_of(const Vector& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

Footprint Footprint::of(const Region& region, const Grid& world, int dims) {
  Footprint f{region, region.volume(dims), dims, {}, {}, {}, {}, {}, {}};
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
  for (int i = 0; i < f.grid.size(); ++i) {
    Polygon part = part_in(region.polygon, f.grid.corner_min(i), f.grid.corner_max(i));
    const double share = area_of(part) / area;
    if (share <= 0) continue;
    f.position_of[i] = static_cast<int>(f.cells.size());
    f.cells.push_back(i);
    f.share.push_back(share);
    f.moments.push_back(moments_of(part));
    f.piece.push_back({std::move(part), region.z_min, region.z_max});
  }
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

double Somewhere::density(const Eigen::Vector3d& point) const {
  if (!footprint_->region.contains(point, footprint_->dims)) return 0;
  const int cell = footprint_->grid.index(point);
  const int i = cell < 0 ? -1 : footprint_->position_of[cell];
  return (i < 0 ? 1.0 : relative(i)) / footprint_->volume;
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

double Somewhere::likelihood(const Gaussian& z) const {
  return looked_at_ ? likelihood(MeasuredIn::of(z, *footprint_))
                    : ::anchord::mass(z, footprint_->region, footprint_->dims) / footprint_->volume;
}

double Somewhere::likelihood(const MeasuredIn& z) const {
  if (!looked_at_) return z.mass / footprint_->volume;
  double relative_height = z.parts.empty() ? 1 : 0;
  for (const auto& [cell, share] : z.parts) relative_height += share * relative(cell);
  return z.scale * relative_height / footprint_->volume;
}

double Somewhere::mass_in(int cell_position) const {
  return footprint_->share[cell_position] * relative(cell_position);
}

double Somewhere::mass(const std::vector<double>& visible) const {
  const auto in_view = cells_of(footprint_->share) * cells_of(visible);
  double sum = 0;
  if (looked_at_)
    sum = (in_view * (weight_looked_ * cells_of(*looked_at_) + uniform())).sum();
  else
    sum = in_view.sum();
  return std::min(sum, 1.0);
}

double Somewhere::entropy() const {
  double sum = 0;
  if (looked_at_)
    for (std::size_t i = 0; i < footprint_->share.size(); ++i)
      if (const double height = relative(i); height > 0)
        sum -= footprint_->share[i] * height * std::log(height);
  return sum + std::log(footprint_->volume);
}

void Somewhere::enter(double weight, double entering) {
  weight_looked_ *= weight / (weight + entering);
  if (weight_looked_ == 0) looked_at_.reset();
}

void Somewhere::miss(double p, const std::vector<double>& visible) {
  auto next = make_pooled<PoolVector<double>>(visible.size());
  Cells heights(next->data(), static_cast<Eigen::Index>(next->size()));
  const auto missed = 1 - p * cells_of(visible);
  if (looked_at_)
    heights = (weight_looked_ * cells_of(*looked_at_) + uniform()) * missed;
  else
    heights = missed;
  // Summed, not 1 - p mass(visible): each miss would divide the rounding error of the sum by that.
  heights *= 1 / (cells_of(footprint_->share) * heights).sum();
  looked_at_ = std::move(next);
  weight_looked_ = 1;
}

Somewhere Somewhere::merge(double weight_a, const Somewhere& a, double weight_b,
                           const Somewhere& b) {
  if (a.looked_at_ == b.looked_at_ && a.weight_looked_ == b.weight_looked_) return a;
  const double u = weight_a / (weight_a + weight_b);
  auto mixed = make_pooled<PoolVector<double>>(a.footprint_->cells.size());
  Cells heights(mixed->data(), static_cast<Eigen::Index>(mixed->size()));
  heights.setConstant(u * a.uniform() + (1 - u) * b.uniform());
  if (a.looked_at_) heights += u * a.weight_looked_ * cells_of(*a.looked_at_);
  if (b.looked_at_) heights += (1 - u) * b.weight_looked_ * cells_of(*b.looked_at_);
  Somewhere out(a.footprint_);
  out.looked_at_ = std::move(mixed);
  out.weight_looked_ = 1;
  return out;
}

Somewhere Somewhere::over(std::shared_ptr<const Footprint> place) const {
  Somewhere out(std::move(place));
  const Footprint& now = *out.footprint_;
  if (now.same_cells(*footprint_)) {
    out.looked_at_ = looked_at_;
    out.weight_looked_ = weight_looked_;
    return out;
  }
  if (!looked_at_) return out;
  auto heights = make_pooled<PoolVector<double>>(now.cells.size(), 1.0);
  double sum = 0;
  for (std::size_t i = 0; i < heights->size(); ++i) {
    const int cell = footprint_->grid.index(now.moments[i].mean);
    if (const int old = cell < 0 ? -1 : footprint_->position_of[cell]; old >= 0)
      (*heights)[i] = relative(static_cast<std::size_t>(old));
    sum += now.share[i] * (*heights)[i];
  }
  if (sum <= 0) return out;  // all that is left of it was looked at in vain
  for (double& height : *heights) height /= sum;
  out.looked_at_ = std::move(heights);
  out.weight_looked_ = 1;
  return out;
}

Gaussian Somewhere::moments() const {
  const Footprint& f = *footprint_;
  // About the first piece: a place may be far from the origin.
  const Eigen::Vector3d& about = f.moments.front().mean;
  Gaussian g;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < f.cells.size(); ++i) {
    const Gaussian& piece = f.moments[i];
    const Eigen::Vector3d d = piece.mean - about;
    const double m = mass_in(static_cast<int>(i));
    g.mean += m * d;
    second += m * (piece.covariance + d * d.transpose());
  }
  g.covariance = second - g.mean * g.mean.transpose();
  g.mean += about;
  if (f.dims == 3) {
    const double height = f.region.z_max - f.region.z_min;
    g.mean.z() = 0.5 * (f.region.z_max + f.region.z_min);
    g.covariance(2, 2) = height * height / 12;
  }
  return g;
}

}  // namespace anchord
