#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace anchord {

/// The standard normal's mass between a and b; negative if b < a.
double normal_between(double a, double b);

/// Mass of the triangle (origin, p, q) under the standard normal of the plane, positive if it runs
/// counter-clockwise. The sum over a polygon's edges is the polygon's mass. By Owen's T function
/// (D. B. Owen, "Tables for computing bivariate normal probabilities", 1956).
double triangle_mass(const Eigen::Vector2d& p, const Eigen::Vector2d& q);

/// Mass of the triangle (origin, p, the far end of the ray from p along the unit vector v).
double ray_triangle_mass(const Eigen::Vector2d& p, const Eigen::Vector2d& v);

/// The upper triangular A with A A' = covariance. Pivots have a floor (1e-14 of the trace and
/// (1e-9 m)^2), so that a singular covariance gives its limit.
template <int N>
Eigen::Matrix<double, N, N> upper_factor(const Eigen::Matrix<double, N, N>& covariance) {
  const double floor = std::max(1e-14 * covariance.trace(), 1e-18);
  Eigen::Matrix<double, N, N> a = Eigen::Matrix<double, N, N>::Zero();
  for (int j = N - 1; j >= 0; --j) {
    double pivot = covariance(j, j);
    for (int k = j + 1; k < N; ++k) pivot -= a(j, k) * a(j, k);
    a(j, j) = std::sqrt(std::max(pivot, floor));
    for (int i = 0; i < j; ++i) {
      double rest = covariance(i, j);
      for (int k = j + 1; k < N; ++k) rest -= a(i, k) * a(j, k);
      a(i, j) = rest / a(j, j);
    }
  }
  return a;
}

/// v solves A v = b for an upper triangular A of two rows.
inline Eigen::Vector2d solve_upper(const Eigen::Matrix2d& a, const Eigen::Vector2d& b) {
  const double y = b.y() / a(1, 1);
  return {(b.x() - a(0, 1) * y) / a(0, 0), y};
}

}  // namespace anchord
