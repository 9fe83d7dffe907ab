#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace anchord {

/// The logarithm of probability zero.
inline constexpr double kLogZero = -std::numeric_limits<double>::infinity();

/// ln(e^a + e^b) without overflow; either may be kLogZero.
inline double log_add(double a, double b) {
  if (a < b) std::swap(a, b);
  return b == kLogZero ? a : a + std::log1p(std::exp(b - a));
}

/// ln(sum of e^x) over a range of doubles; kLogZero for an empty one. Sums in the range's order.
template <typename Range, typename Projection>
double log_sum(const Range& range, Projection log_of) {
  double top = kLogZero;
  for (const auto& x : range) top = std::max(top, static_cast<double>(log_of(x)));
  if (top == kLogZero) return kLogZero;
  double sum = 0;
  for (const auto& x : range) sum += std::exp(log_of(x) - top);
  return top + std::log(sum);
}

}  // namespace anchord
