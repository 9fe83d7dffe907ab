#include "anchoring/seen_share.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/pool.h"

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

double SeenShare::Curve::at(double v) const {
  Point below{0, 0};
  for (std::size_t i = 0; i <= count; ++i) {
    const Point above = i < count ? points[i] : Point{1, 1};
    if (v <= above.v)
      return below.share + (above.share - below.share) * (v - below.v) / (above.v - below.v);
    below = above;
  }
  return 1;
}

double SeenShare::Curve::kept(double now) const {
  return now > variance ? std::sqrt(variance / now) : 1;
}

/// Keeps of ascending points as many as there is room for: always the one at v; of the others those
/// go that are nearest to the line between their neighbours.
template <std::size_t Most>
void SeenShare::Curve::keep(std::array<Point, Most>& all, std::size_t number, double v) {
  for (; number > kMost; --number) {
    std::size_t least = 0;
    double smallest = 2;  // twice an area in the unit square
    for (std::size_t i = 0; i < number; ++i) {
      if (all[i].v == v) continue;
      const Point below = i > 0 ? all[i - 1] : Point{0, 0};
      const Point above = i + 1 < number ? all[i + 1] : Point{1, 1};
      const double area = std::abs((all[i].v - below.v) * (above.share - below.share) -
                                   (above.v - below.v) * (all[i].share - below.share));
      if (area < smallest) smallest = area, least = i;
    }
    std::copy(all.begin() + least + 1, all.begin() + number, all.begin() + least);
  }
  count = number;
  std::copy_n(all.begin(), number, points.begin());
}

std::size_t SeenShare::Curve::point_at(double v) {
  std::array<Point, kMost + 1> all;
  std::size_t i = 0;
  for (; i < count && points[i].v < v - kSame; ++i) all[i] = points[i];
  if (i < count && points[i].v <= v + kSame) return i;
  all[i] = {v, at(v)};
  std::copy(points.begin() + i, points.begin() + count, all.begin() + i + 1);
  keep(all, count + 1, v);
  for (i = 0; points[i].v != v;) ++i;
  return i;
}

double SeenShare::share(const SeenPart& part) const {
  if (!curve_ || part.viewer != curve_->viewer || !cuts(part.v)) return part.v;
  return part.v + curve_->kept(part.variance) * (curve_->at(part.v) - part.v);
}

double SeenShare::factor(const SeenPart& part) const {
  return cuts(part.v) ? share(part) / part.v : 1;
}

void SeenShare::miss(const SeenPart& part, double lost) {
  if (lost <= 0 || part.v <= kNothing) return;
  if (!cuts(part.v)) return curve_.reset();
  const bool known = curve_ && curve_->viewer == part.viewer;
  auto next = make_pooled<Curve>(known ? *curve_ : Curve());
  const double k = next->kept(part.variance);
  for (std::size_t i = 0; i < next->count; ++i) {
    Point& point = next->points[i];
    point.share = point.v + k * (point.share - point.v);
  }
  next->viewer = part.viewer;
  next->variance = part.variance;
  next->toward = part.toward;
  const std::size_t seen = next->point_at(part.v);
  const double before = next->points[seen].share;  // down to nothing
  const double left = before > lost ? 1 - lost / before : 0;
  for (std::size_t i = 0; i < next->count; ++i) {
    double& share = next->points[i].share;
    share = (i <= seen ? left * share : share - lost) / (1 - lost);
  }
  curve_ = std::move(next);
}

void SeenShare::find(const SeenPart& part) {
  curve_.reset();
  if (part.v < kHardly || !cuts(part.v)) return;
  curve_ =
      make_pooled<Curve>(Curve{part.viewer, part.variance, part.toward, 1, {Point{part.v, 1}}});
}

Kinematic SeenShare::told(const Kinematic& density, int dims) const {
  if (!curve_) return density;
  const auto& [viewer, variance, toward, count, points] = *curve_;
  const double a = toward.dot(density.pp * toward);
  if (a <= 0) return density;
  // In standard deviations t towards the view, of which the part of mass v lies above
  // sqrt(2) erfc^-1(2 v); between two points the density is so many times what it was.
  const double k = curve_->kept(variance_of(density, dims));
  double mean = 0, square = 0;
  Point below{0, 0};
  double bell_below = 0, t_bell_below = 0;  // phi(t), t phi(t)
  for (std::size_t i = 0; i <= count; ++i) {
    const Point above = i < count ? points[i] : Point{1, 1};
    double bell = 0, t_bell = 0;
    if (i < count) {
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
  const Eigen::Vector3d step = density.pp * toward / std::sqrt(a);
  const Eigen::Vector3d faster = density.pv.transpose() * toward / std::sqrt(a);
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
  if (!a.curve_ && !b.curve_) return a;
  if (weight_a < weight_b) return merge(weight_b, b, weight_a, a);
  if (a.curve_ && b.curve_ && a.curve_->viewer != b.curve_->viewer)
    return merge(weight_a, a, weight_b, SeenShare());
  static const Curve kUnseen;
  const Curve &in_a = a.curve_ ? *a.curve_ : kUnseen, &in_b = b.curve_ ? *b.curve_ : kUnseen;
  const double wa = weight_a / (weight_a + weight_b);
  std::array<Point, 2 * kMost> points;
  std::size_t count = 0;
  for (std::size_t i = 0, j = 0; i < in_a.count || j < in_b.count;) {
    const double next_a = i < in_a.count ? in_a.points[i].v : 2;
    const double next_b = j < in_b.count ? in_b.points[j].v : 2;
    const double v = std::min(next_a, next_b);
    points[count++] = {v, wa * in_a.at(v) + (1 - wa) * in_b.at(v)};
    if (next_a <= v + kSame) ++i;
    if (next_b <= v + kSame) ++j;
  }
  auto mixed = make_pooled<Curve>(a.curve_ ? in_a : in_b);
  if (a.curve_ && b.curve_) {
    mixed->variance = wa * in_a.variance + (1 - wa) * in_b.variance;
    mixed->toward = wa * in_a.toward + (1 - wa) * in_b.toward;
  }
  mixed->keep(points, count, 0);
  SeenShare out;
  out.curve_ = std::move(mixed);
  return out;
}

double SeenShare::difference(const SeenShare& a, const SeenShare& b) {
  if (a.curve_ == b.curve_) return 0;
  double most = 0;
  for (const auto& curve : {a.curve_, b.curve_})
    for (std::size_t i = 0; curve && i < curve->count; ++i)
      most = std::max(most, std::abs(a.at(curve->points[i].v) - b.at(curve->points[i].v)));
  return most;
}

}  // namespace anchord
