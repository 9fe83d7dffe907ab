#include "models/somewhere.h"

#include <algorithm>
#include <cmath>

#include "geometry/gaussian_mass.h"

namespace anchord {

double Somewhere::density(const Eigen::Vector3d& point) const {
  if (!footprint_->region.contains(point, footprint_->dims)) return 0;
  const int cell = footprint_->grid.index(point);
  const int i = cell < 0 ? -1 : footprint_->position_of[cell];
  return (i < 0 ? 1.0 : relative(i)) / footprint_->volume;
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

double Somewhere::mass(const CellShares& shares) const {
  double sum = uniform() * shares.total();
  if (looked_at_) sum += weight_looked_ * looked_at_->mass(shares, *footprint_);
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

std::shared_ptr<RelativeHeights> Somewhere::heights() const {
  if (!looked_at_) return make_pooled<RelativeHeights>(*footprint_);
  auto all = make_pooled<RelativeHeights>(*looked_at_);
  all->change(weight_looked_, uniform());
  return all;
}

void Somewhere::miss(double p, const CellShares& visible) {
  auto next = heights();
  next->miss(p, visible, *footprint_);
  // Summed, not 1 - p mass(visible): each miss would divide the rounding error of the sum by that.
  next->change(1 / next->mass(*footprint_), 0);
  looked_at_ = std::move(next);
  weight_looked_ = 1;
}

Somewhere Somewhere::merge(double weight_a, const Somewhere& a, double weight_b,
                           const Somewhere& b) {
  if (a.looked_at_ == b.looked_at_ && a.weight_looked_ == b.weight_looked_) return a;
  Somewhere out(a.footprint_);
  auto mixed = a.heights();
  mixed->mix(weight_a / (weight_a + weight_b), *b.heights(), *a.footprint_);
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
  std::vector<double> heights(now.cells.size(), 1.0);
  double sum = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const int cell = footprint_->grid.index(now.moments[i].mean);
    if (const int old = cell < 0 ? -1 : footprint_->position_of[cell]; old >= 0)
      heights[i] = relative(static_cast<std::size_t>(old));
    sum += now.share[i] * heights[i];
  }
  if (sum <= 0) return out;  // all that is left of it was looked at in vain
  auto looked_at = out.heights();
  looked_at->set(heights, now);
  looked_at->change(1 / sum, 0);
  out.looked_at_ = std::move(looked_at);
  out.weight_looked_ = 1;
  return out;
}

void Somewhere::set_in_grid_order(const PoolVector<double>& heights) {
  std::vector<double> ordered(footprint_->cells.size());
  std::size_t next = 0;
  for (const int position : footprint_->position_of)
    if (position >= 0 && next < heights.size()) ordered[position] = heights[next++];
  auto looked_at = make_pooled<RelativeHeights>(*footprint_);
  looked_at->set(ordered, *footprint_);
  looked_at_ = std::move(looked_at);
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
