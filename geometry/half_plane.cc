#include "geometry/half_plane.h"

#include <array>
#include <limits>

#include "geometry/quadrature.h"

namespace anchord {
namespace {

using Eigen::Vector2d;

constexpr double kPi = std::numbers::pi;
const double kRootTwoPi = std::sqrt(2 * kPi);

/// A Gauss-Hermite rule: the integral of f(t) exp(-t^2 / 2).
template <std::size_t Pairs>
struct Hermite {
  double middle;
  std::array<double, Pairs> node, weight;  ///< the weights sum to 1

  template <typename Function>
  double integrate(const Function& f) const {
    double sum = middle * f(0.0);
    for (std::size_t i = 0; i < Pairs; ++i) sum += weight[i] * (f(-node[i]) + f(node[i]));
    return kRootTwoPi * sum;
  }
};

// Abramowitz and Stegun, "Handbook of Mathematical Functions" (1964), table 25.10, for this weight.
constexpr Hermite<1> kThree{0.666666666666666667, {1.732050807568877294}, {0.166666666666666667}};
constexpr Hermite<2> kFive{0.533333333333333333,
                           {1.355626179974265907, 2.856970013872805678},
                           {0.222075922005612645, 0.011257411327720689}};
constexpr Hermite<4> kNine{
    0.406349206349206349,
    {1.023255663789132525, 2.076847978677829790, 3.205429002856470274, 4.512745863399782579},
    {0.244097502894939087, 0.049916406765217872, 0.002789141321231769, 0.000022345844007746}};

}  // namespace

double HalfPlane::direction_of(const Vector2d& direction) const {
  const Vector2d v = solve_upper(unfold, direction);
  return std::atan2(v.y(), v.x());
}

/// In closed form: the mean's share, and by the divergence theorem what the two rays cut off.
double HalfPlane::between_rays(double first, double second) const {
  const Vector2d c = unfold.row(0);
  const auto edge = [&](double theta, double& share) {
    const Vector2d v(std::cos(theta), std::sin(theta));
    share = ray_triangle_mass(-mean, v);
    const double off = v.x() * mean.y() - v.y() * mean.x();
    const double on_ray =
        std::exp(-off * off / 2) * kRootTwoPi / 2 * std::erfc(-v.dot(mean) / std::numbers::sqrt2);
    return on_ray * (c.x() * v.y() - c.y() * v.x());
  };
  double share_first, share_second;
  const double cut = edge(second, share_second) - edge(first, share_first);
  const double mass = second - first + 2 * kPi * (share_first - share_second);
  return c.dot(mean) * mass + cut;
}

/// In closed form along the line of one height: outward between what elevation and range allow.
double HalfPlane::at_height(double white_height) const {
  const double up = unfold(1, 1) * white_height, shift = unfold(0, 1) * white_height;
  const double by_low = up * low.x(), by_high = up * high.x();
  double near = 0, far = std::numeric_limits<double>::infinity();
  if (low.y() < 0)
    near = std::max(near, by_low / low.y());
  else if (low.y() > 0)
    far = by_low / low.y();
  else if (by_low < 0)
    return 0;
  if (high.y() > 0)
    near = std::max(near, by_high / high.y());
  else if (high.y() < 0)
    far = std::min(far, by_high / high.y());
  else if (by_high > 0)
    return 0;
  const double beside = range_max * range_max - up * up;
  if (beside <= 0) return 0;
  far = std::min(far, std::sqrt(beside));
  if (range_min > std::abs(up)) near = std::max(near, std::sqrt(range_min * range_min - up * up));
  if (far <= near) return 0;
  const double m = mean.x();
  const RayPart part((near - shift) / unfold(0, 0) - m, (far - shift) / unfold(0, 0) - m);
  return unfold(0, 0) * (part.at_start - part.at_end + m * part.between) + shift * part.between;
}

/// Whether the limits outward change by at most as many standard deviations as the height does:
/// then what lies between them is a smooth function of the height, for which few heights do.
bool HalfPlane::changes_slowly(const MassPrecision& precision) const {
  const double highest = unfold(1, 1) * (std::abs(mean.y()) + precision.clear);
  const double nearest = (unfold * mean).norm() - precision.clear * unfold.norm();
  if (highest > range_max / 2 || (range_min > 0 && nearest < range_min)) return false;
  const auto per_height = [](const Vector2d& limit) {
    return limit.y() == 0 ? 0 : std::abs(limit.x() / limit.y());
  };
  const double steepest = std::max({per_height(low), per_height(high), highest / range_max * 1.2});
  return std::abs(unfold(0, 1)) + unfold(1, 1) * steepest <= unfold(0, 0);
}

double HalfPlane::moment(bool any_range, const MassPrecision& precision, double tolerance) const {
  const double farthest = (unfold * mean).norm() + precision.clear * unfold.norm();
  if (any_range || (range_min == 0 && farthest <= range_max))
    return between_rays(direction_of(low), direction_of(high));
  if (changes_slowly(precision)) {
    const auto height = [&](double t) { return at_height(mean.y() + t); };
    const double three = kThree.integrate(height), five = kFive.integrate(height);
    if (std::abs(five - three) <= tolerance) return five;
    const double nine = kNine.integrate(height);
    if (std::abs(nine - five) <= tolerance) return nine;
  }
  const auto ray = [&](double theta) {
    const Vector2d v(std::cos(theta), std::sin(theta));
    const Vector2d along_ray = unfold * v;
    const double reach = along_ray.norm();
    const double aside = v.x() * mean.y() - v.y() * mean.x();
    // d(area) is s ds d(theta); its distance from the z axis is s along_ray.x().
    return along_ray.x() * std::exp(-aside * aside / 2) *
           second_moment(v.dot(mean), range_min / reach, range_max / reach);
  };
  const WhitePlane plane(unfold, mean, precision.reach);
  return integrate_around(ray, direction_of(low), direction_of(high), plane.peak, plane.reach,
                          tolerance, 12);
}

}  // namespace anchord
