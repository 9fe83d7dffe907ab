#include "geometry/standard_normal.h"

#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/owens_t.hpp>
#include <numbers>

namespace anchord {
namespace {

/// Beyond this distance from the mean T is below 1e-18.
constexpr double kFar = 9;
constexpr double kTurn = 2 * std::numbers::pi;

/// T(h, k/h) for a line at distance h > 0 from the origin, up to the point k from its foot.
double owens_t(double h, double k) {
  using boost::math::policies::policy;
  using boost::math::policies::promote_double;
  // Where k is far out T is that of the whole ray, Phi(-h)/2.
  if (std::abs(k) > kFar) return std::copysign(std::erfc(h / std::numbers::sqrt2) / 4, k);
  return boost::math::owens_t(h, k / h, policy<promote_double<false>>());
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

double normal_between(double a, double b) {
  const double x = a / std::numbers::sqrt2, y = b / std::numbers::sqrt2;
  // On the side of the tail, so that small masses keep their digits.
  return x + y > 0 ? (std::erfc(x) - std::erfc(y)) / 2 : (std::erfc(-y) - std::erfc(-x)) / 2;
}

double triangle_mass(const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  const Eigen::Vector2d edge = q - p;
  const double length = edge.norm();
  const double area = cross(p, edge);
  if (length == 0 || area == 0) return 0;
  const double h = std::abs(area) / length;
  double mass = std::abs(std::atan2(cross(p, q), p.dot(q))) / kTurn;
  if (h < kFar) {
    const double from = p.dot(edge) / length, to = q.dot(edge) / length;
    const bool passes_by = std::min(from, to) > kFar || std::max(from, to) < -kFar;
    if (!passes_by) mass -= owens_t(h, to) - owens_t(h, from);
  }
  return std::copysign(mass, area);
}

double ray_triangle_mass(const Eigen::Vector2d& p, const Eigen::Vector2d& v) {
  const double area = cross(p, v);
  if (area == 0) return 0;
  const double h = std::abs(area), from = p.dot(v);
  double mass = std::atan2(h, from) / kTurn;
  if (h < kFar) mass -= std::erfc(h / std::numbers::sqrt2) / 4 - owens_t(h, from);
  return std::copysign(mass, area);
}

}  // namespace anchord
