#include "models/somewhere.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/gaussian_mass.h"

namespace anchord {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

/// The part of a polygon where a linear function is not negative (Sutherland and Hodgman 1974).
/// What falls apart stays joined by edges that go there and back, which have no area.
template <typename Function>
Polygon clipped(const Polygon& polygon, const Function& height) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = height(a), at_b = height(b);
    if (at_a >= 0) out.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) out.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return out;
}

double area_in(const Polygon& polygon, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  Polygon part = polygon;
  for (int axis = 0; axis < 2 && !part.empty(); ++axis) {
    part = clipped(part, [&](const Eigen::Vector2d& p) { return p[axis] - min[axis]; });
    part = clipped(part, [&](const Eigen::Vector2d& p) { return max[axis] - p[axis]; });
  }
  return part.size() < 3 ? 0.0 : Region{part}.area();
}

/// How far `p` lies to the left of the line from `a` to `b`, times its length.
double left_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// The polygon counter-clockwise if it is convex, else nothing.
Polygon as_convex(Polygon polygon) {
  const std::size_t n = polygon.size();
  bool left = false, right = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = left_of(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  if (left && right) return {};
  if (right) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// What two polygons have in common, if one of them is convex.
std::optional<Polygon> common_part(const Polygon& a, const Polygon& b) {
  Polygon convex = as_convex(a), part = b;
  if (convex.empty()) convex = as_convex(b), part = a;
  if (convex.empty()) return std::nullopt;
  for (std::size_t i = 0; i < convex.size() && !part.empty(); ++i)
    part = clipped(part, [&, &from = convex[i], &to = convex[(i + 1) % convex.size()]](
                             const Eigen::Vector2d& p) { return left_of(from, to, p); });
  return part;
}

}  // namespace

Footprint Footprint::of(const Region& region, const Grid& world, int dims) {
  Footprint f{region, region.volume(dims), dims, {}, {}, {}, {}};
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
    const double part = area_in(region.polygon, f.grid.corner_min(i), f.grid.corner_max(i)) / area;
    if (part <= 0) continue;
    f.position_of[i] = static_cast<int>(f.cells.size());
    f.cells.push_back(i);
    f.share.push_back(part);
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
    const double part = common ? area_in(*common, low, high) / (share[i] * area)
                               : area_in(other.polygon, low, high) / (grid.cell * grid.cell);
    out[i] = height * std::min(part, 1.0);
  }
  return out;
}

std::vector<double> Footprint::visible(const MapView& view) const {
  std::vector<double> out(cells.size(), view.sees_everything() ? 1.0 : 0.0);
  if (view.sees_everything() || view.sees_nothing()) return out;
  const auto seen = view.bounds();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Eigen::Vector3d low = grid.corner_min(cells[i]), high = grid.corner_max(cells[i]);
    if (high.x() < seen[0] || high.y() < seen[1] || low.x() > seen[2] || low.y() > seen[3])
      continue;
    out[i] = view.share(low, high);
  }
  return out;
}

double Somewhere::density(const Eigen::Vector3d& point) const {
  if (!footprint_->region.contains(point, footprint_->dims)) return 0;
  const int cell = footprint_->grid.index(point);
  const int i = cell < 0 ? -1 : footprint_->position_of[cell];
  return (i < 0 ? 1.0 : relative(i)) / footprint_->volume;
}

double Somewhere::likelihood(const Gaussian& z) const {
  return likelihood(z, ::anchord::mass(z, footprint_->region, footprint_->dims));
}

double Somewhere::likelihood(const Gaussian& z, double uniform) const {
  if (!looked_at_ || uniform <= 0) return uniform / footprint_->volume;
  const double spread2 = std::max(z.covariance(0, 0), z.covariance(1, 1));
  if (spread2 * 16 < footprint_->grid.cell * footprint_->grid.cell && uniform > 0.999)
    return density(z.mean);
  // The mean of the density's relative height around z, weighted by what lies in the place.
  constexpr double kQuantiles[5] = {-1.2815515655446, -0.5244005127080, 0, 0.5244005127080,
                                    1.2815515655446};  // of N(0, 1) at 0.1, 0.3, .. 0.9
  const Eigen::Matrix2d root =
      Eigen::LLT<Eigen::Matrix2d>(z.covariance.topLeftCorner<2, 2>()).matrixL();
  double sum = 0;
  int hits = 0;
  for (double a : kQuantiles)
    for (double b : kQuantiles) {
      Eigen::Vector3d x = z.mean;
      x.head<2>() += root * Eigen::Vector2d(a, b);
      const int cell = footprint_->grid.index(x);
      const int i = cell < 0 ? -1 : footprint_->position_of[cell];
      if (i >= 0) sum += relative(i), ++hits;
    }
  return uniform * (hits ? sum / hits : 1.0) / footprint_->volume;
}

double Somewhere::mass_in(int cell_position) const {
  return footprint_->share[cell_position] * relative(cell_position);
}

double Somewhere::mass(const std::vector<double>& visible) const {
  double sum = 0;
  for (std::size_t i = 0; i < visible.size(); ++i)
    if (visible[i] > 0) sum += footprint_->share[i] * relative(i) * visible[i];
  return std::min(sum, 1.0);
}

void Somewhere::enter(double weight, double entering) {
  weight_looked_ *= weight / (weight + entering);
  if (weight_looked_ == 0) looked_at_.reset();
}

void Somewhere::miss(double p, const std::vector<double>& visible) {
  auto next = std::make_shared<std::vector<double>>(visible.size());
  // Summed, not 1 - p mass(visible): each miss would divide the rounding error of the sum by that.
  double rest = 0;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    (*next)[i] = relative(i) * (1 - p * visible[i]);
    rest += footprint_->share[i] * (*next)[i];
  }
  for (double& height : *next) height /= rest;
  looked_at_ = std::move(next);
  weight_looked_ = 1;
}

Somewhere Somewhere::merge(double weight_a, const Somewhere& a, double weight_b,
                           const Somewhere& b) {
  if (a.looked_at_ == b.looked_at_ && a.weight_looked_ == b.weight_looked_) return a;
  const double u = weight_a / (weight_a + weight_b);
  auto mixed = std::make_shared<std::vector<double>>(a.footprint_->cells.size());
  for (std::size_t i = 0; i < mixed->size(); ++i)
    (*mixed)[i] = u * a.relative(i) + (1 - u) * b.relative(i);
  Somewhere out(a.footprint_);
  out.looked_at_ = std::move(mixed);
  out.weight_looked_ = 1;
  return out;
}

Gaussian Somewhere::moments() const {
  const Footprint& f = *footprint_;
  Gaussian g;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  // About the middle of the grid: places may be far from the origin.
  Eigen::Vector3d about = 0.5 * (f.grid.corner_min(0) + f.grid.corner_max(f.grid.size() - 1));
  if (f.dims == 2) about.z() = 0;
  for (std::size_t i = 0; i < f.cells.size(); ++i) {
    Eigen::Vector3d d =
        0.5 * (f.grid.corner_min(f.cells[i]) + f.grid.corner_max(f.cells[i])) - about;
    d.z() = 0;  // every column is as high as the place
    const double m = mass_in(static_cast<int>(i));
    g.mean += m * d;
    second += m * d * d.transpose();
  }
  second -= g.mean * g.mean.transpose();
  g.covariance = 0.5 * (second + second.transpose());  // to rounding it was symmetric already
  g.mean += about;
  const double in_cell = f.grid.cell * f.grid.cell / 12;  // variance inside a cell
  g.covariance(0, 0) += in_cell;
  g.covariance(1, 1) += in_cell;
  if (f.dims == 3) {
    const double height = f.region.z_max - f.region.z_min;
    g.covariance(2, 2) += height * height / 12;
  }
  return g;
}

}  // namespace anchord
