#include "anchoring/seen_share.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

namespace anchord {
namespace {

constexpr double kSame = 1e-12;    // masses closer than that are one
constexpr double kNothing = 1e-6;  // a part this small is none
constexpr double kHardly = 1e-3;   // what is found where so little could be says the view is wrong

}  // namespace

double variance_of(const Kinematic& density, int dims) {
  return dims == 3 ? std::cbrt(density.pp.determinant())
                   : std::sqrt(density.pp.topLeftCorner<2, 2>().determinant());
}

bool SeenShare::cuts(double v) { return v > kNothing && v < 1 - kNothing; }

double SeenShare::at(double v) const {
  Point below{0, 0};
  for (std::size_t i = 0; i <= count_; ++i) {
    const Point above = i < count_ ? points_[i] : Point{1, 1};
    if (v <= above.v)
      return below.share + (above.share - below.share) * (v - below.v) / (above.v - below.v);
    below = above;
  }
  return 1;
}

double SeenShare::kept(double variance) const {
  return variance > variance_ ? std::sqrt(variance_ / variance) : 1;
}

double SeenShare::share(const SeenPart& part) const {
  if (count_ == 0 || part.viewer != viewer_ || !cuts(part.v)) return part.v;
  return part.v + kept(part.variance) * (at(part.v) - part.v);
}

/// Keeps of ascending points as many as there is room for: always the one at v; of the others those
/// go that are nearest to the line between their neighbours.
template <std::size_t Most>
void SeenShare::keep(std::array<Point, Most>& points, std::size_t count, double v) {
  for (; count > kMost; --count) {
    std::size_t least = 0;
    double smallest = 2;  // twice an area in the unit square
    for (std::size_t i = 0; i < count; ++i) {
      if (points[i].v == v) continue;
      const Point below = i > 0 ? points[i - 1] : Point{0, 0};
      const Point above = i + 1 < count ? points[i + 1] : Point{1, 1};
      const double area = std::abs((points[i].v - below.v) * (above.share - below.share) -
                                   (above.v - below.v) * (points[i].share - below.share));
      if (area < smallest) smallest = area, least = i;
    }
    std::copy(points.begin() + least + 1, points.begin() + count, points.begin() + least);
  }
  count_ = static_cast<std::uint32_t>(count);
  std::copy_n(points.begin(), count, points_.begin());
}

std::size_t SeenShare::point_at(double v) {
  std::array<Point, kMost + 1> points;
  std::size_t i = 0;
  for (; i < count_ && points_[i].v < v - kSame; ++i) points[i] = points_[i];
  if (i < count_ && points_[i].v <= v + kSame) return i;
  points[i] = {v, at(v)};
  std::copy(points_.begin() + i, points_.begin() + count_, points.begin() + i + 1);
  keep(points, count_ + 1, v);
  for (i = 0; points_[i].v != v;) ++i;
  return i;
}

double SeenShare::factor(const SeenPart& part) const {
  return cuts(part.v) ? share(part) / part.v : 1;
}

void SeenShare::remember(const SeenPart& part) {
  viewer_ = part.viewer;
  variance_ = part.variance;
  toward_ = part.toward;
}

void SeenShare::miss(const SeenPart& part, double lost) {
  if (lost <= 0 || part.v <= kNothing) return;
  if (!cuts(part.v) || part.viewer != viewer_) count_ = 0;
  if (!cuts(part.v)) return;
  const double k = kept(part.variance);
  for (std::size_t i = 0; i < count_; ++i)
    points_[i].share = points_[i].v + k * (points_[i].share - points_[i].v);
  remember(part);
  const std::size_t seen = point_at(part.v);
  const double before = points_[seen].share;  // down to nothing
  const double left = before > lost ? 1 - lost / before : 0;
  for (std::size_t i = 0; i < count_; ++i)
    points_[i].share = (i <= seen ? left * points_[i].share : points_[i].share - lost) / (1 - lost);
}

void SeenShare::find(const SeenPart& part) {
  remember(part);
  count_ = part.v >= kHardly && cuts(part.v) ? 1 : 0;
  points_[0] = {part.v, 1};
}

Kinematic SeenShare::told(const Kinematic& density, int dims) const {
  const double a = toward_.dot(density.pp * toward_);
  if (count_ == 0 || a <= 0) return density;
  // In standard deviations t towards the view, of which the part of mass v lies above
  // sqrt(2) erfc^-1(2 v); between two points the density is so many times what it was.
  const double k = kept(variance_of(density, dims));
  double mean = 0, square = 0;
  Point below{0, 0};
  double bell_below = 0, t_bell_below = 0;  // phi(t), t phi(t)
  for (std::size_t i = 0; i <= count_; ++i) {
    const Point above = i < count_ ? points_[i] : Point{1, 1};
    double bell = 0, t_bell = 0;
    if (i < count_) {
      const double t = std::numbers::sqrt2 * boost::math::erfc_inv(2 * above.v);
      bell = std::exp(-t * t / 2) / std::sqrt(2 * std::numbers::pi);
      t_bell = t * bell;
    }
    const double v = above.v - below.v;
    const double times = 1 + k * ((above.share - below.share) / v - 1);
    mean += times * (bell - bell_below);
    square += times * (v + t_bell - t_bell_below);
    below = above, bell_below = bell, t_bell_below = t_bell;
  }
  const double wider = square - mean * mean - 1;
  const Eigen::Vector3d step = density.pp * toward_ / std::sqrt(a);
  const Eigen::Vector3d faster = density.pv.transpose() * toward_ / std::sqrt(a);
  Kinematic out = density;
  out.position += mean * step;
  out.velocity += mean * faster;
  out.pp += wider * step * step.transpose();
  out.pv += wider * step * faster.transpose();
  out.vv += wider * faster * faster.transpose();
  return out;
}

SeenShare SeenShare::merge(double weight_a, const SeenShare& a, double weight_b,
                           const SeenShare& b) {
  if (a.count_ == 0 && b.count_ == 0) return a;
  if (weight_a < weight_b) return merge(weight_b, b, weight_a, a);
  if (a.count_ > 0 && b.count_ > 0 && a.viewer_ != b.viewer_)
    return merge(weight_a, a, weight_b, SeenShare());
  const double wa = weight_a / (weight_a + weight_b);
  std::array<Point, 2 * kMost> points;
  std::size_t count = 0;
  for (std::size_t i = 0, j = 0; i < a.count_ || j < b.count_;) {
    const double in_a = i < a.count_ ? a.points_[i].v : 2;
    const double in_b = j < b.count_ ? b.points_[j].v : 2;
    const double v = std::min(in_a, in_b);
    points[count++] = {v, wa * a.at(v) + (1 - wa) * b.at(v)};
    if (in_a <= v + kSame) ++i;
    if (in_b <= v + kSame) ++j;
  }
  SeenShare out = a.count_ > 0 ? a : b;
  if (a.count_ > 0 && b.count_ > 0) out.variance_ = wa * a.variance_ + (1 - wa) * b.variance_;
  if (a.count_ > 0 && b.count_ > 0) out.toward_ = wa * a.toward_ + (1 - wa) * b.toward_;
  out.keep(points, count, 0);
  return out;
}

double SeenShare::difference(const SeenShare& a, const SeenShare& b) {
  double most = 0;
  for (const SeenShare* s : {&a, &b})
    for (std::size_t i = 0; i < s->count_; ++i)
      most = std::max(most, std::abs(a.at(s->points_[i].v) - b.at(s->points_[i].v)));
  return most;
}

}  // namespace anchord
