#include "tools/anchor_tune/estimate.h"

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <cstdio>

namespace anchord::tuning {
namespace {

constexpr double kTail = 0.025;

double chi_squared(double p, double degrees) {
  return boost::math::quantile(boost::math::chi_squared(degrees), p);
}

}  // namespace

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string Estimate::text() const {
  return rounded(value) + " (95 %: " + rounded(low) + " to " + rounded(high) + ")";
}

Estimate poisson_rate(std::int64_t count, double exposure) {
  const auto n = static_cast<double>(count);
  return {n / exposure, count > 0 ? chi_squared(kTail, 2 * n) / 2 / exposure : 0,
          chi_squared(1 - kTail, 2 * n + 2) / 2 / exposure};
}

Estimate binomial_share(std::int64_t count, std::int64_t trials) {
  const auto k = static_cast<double>(count), n = static_cast<double>(trials);
  using boost::math::beta_distribution;
  return {k / n, count > 0 ? quantile(beta_distribution<>(k, n - k + 1), kTail) : 0,
          count < trials ? quantile(beta_distribution<>(k + 1, n - k), 1 - kTail) : 1};
}

Estimate variance_scale(double sum, std::int64_t count) {
  const auto n = static_cast<double>(count);
  return {sum / n, sum / chi_squared(1 - kTail, n), sum / chi_squared(kTail, n)};
}

}  // namespace anchord::tuning
