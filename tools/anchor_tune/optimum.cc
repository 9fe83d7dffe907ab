#include "tools/anchor_tune/optimum.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numeric>

namespace anchord::tuning {
namespace {

constexpr double kFall = 1.92;  // half of 1.96^2
constexpr double kDeviations = 1.96;
constexpr double kTolerance = 1e-3;  // of a log-likelihood: nobody can tell

/// One run of the simplex; coefficients as published.
Optimum simplex(const LogLikelihood& f, const std::vector<double>& start, double step, int budget) {
  const std::size_t n = start.size();
  std::vector<std::vector<double>> corners(n + 1, start);
  std::vector<double> values;
  int evaluations = 0;
  const auto at = [&](const std::vector<double>& x) {
    ++evaluations;
    const double value = f(x);
    return std::isfinite(value) ? value : -1e300;
  };
  for (std::size_t i = 0; i <= n; ++i) {
    if (i > 0) corners[i][i - 1] += step;
    values.push_back(at(corners[i]));
  }
  std::vector<std::size_t> order(n + 1);
  std::iota(order.begin(), order.end(), 0);
  while (true) {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
    const std::size_t best = order[0], worst = order[n];
    if (values[best] - values[worst] < kTolerance || evaluations >= budget)
      return {corners[best], values[best], evaluations};
    std::vector<double> centre(n, 0.0);
    for (std::size_t c = 0; c < n; ++c)
      for (std::size_t i = 0; i < n; ++i)
        centre[i] += corners[order[c]][i] / static_cast<double>(n);
    const auto beyond = [&](double factor) {
      std::vector<double> x(n);
      for (std::size_t i = 0; i < n; ++i)
        x[i] = centre[i] + factor * (corners[worst][i] - centre[i]);
      return x;
    };
    const auto take = [&](std::vector<double> x, double value) {
      corners[worst] = std::move(x);
      values[worst] = value;
    };
    auto reflected = beyond(-1);
    const double value = at(reflected);
    if (value > values[best]) {
      auto expanded = beyond(-2);
      const double further = at(expanded);
      further > value ? take(std::move(expanded), further) : take(std::move(reflected), value);
    } else if (value > values[order[n - 1]]) {
      take(std::move(reflected), value);
    } else {
      auto contracted = beyond(value > values[worst] ? -0.5 : 0.5);
      const double nearer = at(contracted);
      if (nearer > std::max(value, values[worst])) {
        take(std::move(contracted), nearer);
      } else {
        for (std::size_t c = 1; c <= n; ++c) {
          auto& x = corners[order[c]];
          for (std::size_t i = 0; i < n; ++i) x[i] = (x[i] + corners[best][i]) / 2;
          values[order[c]] = at(x);
        }
      }
    }
  }
}

/// The best value with parameter i held; the others start from `from`, and end there.
double profile(const LogLikelihood& f, std::vector<double>& from, std::size_t i, double held) {
  std::vector<double> full = from;
  full[i] = held;
  if (full.size() == 1) return f(full);
  std::vector<double> others = from;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
  const auto rest = [&](const std::vector<double>& x) {
    std::copy(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(i), full.begin());
    std::copy(x.begin() + static_cast<std::ptrdiff_t>(i), x.end(),
              full.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return f(full);
  };
  if (others.size() == 1) {
    const auto cost = [&](double x) { return -rest({x}); };
    const auto [x, least] =
        boost::math::tools::brent_find_minima(cost, others[0] - 2, others[0] + 2, 10);
    from[i == 0 ? 1 : 0] = x;
    return -least;
  }
  const Optimum best = simplex(rest, others, 0.2, 200);
  from = best.at;
  from.insert(from.begin() + static_cast<std::ptrdiff_t>(i), held);
  return best.value;
}

double end_of_profile(const LogLikelihood& f, const Optimum& best, std::size_t i, double side) {
  double inside = 0, outside = 0.05;
  std::vector<double> from = best.at;
  const auto falls = [&](double by) {
    return profile(f, from, i, best.at[i] + side * by) < best.value - kFall;
  };
  while (!falls(outside)) {
    if (outside >= kReach) return best.at[i] + side * kReach;
    inside = outside;
    outside *= 2;
  }
  while (outside - inside > 0.02 * outside) {  // two digits of a width are enough
    const double middle = (inside + outside) / 2;
    (falls(middle) ? outside : inside) = middle;
  }
  return best.at[i] + side * (inside + outside) / 2;
}

}  // namespace

double to_free(double value, Scale scale) {
  if (scale == Scale::kFree) return value;
  if (scale == Scale::kPerMetre) return value * kRangeStep;
  return scale == Scale::kLog ? std::log(value) : std::log(value) - std::log1p(-value);
}

double from_free(double free, Scale scale) {
  if (scale == Scale::kFree) return free;
  if (scale == Scale::kPerMetre) return free / kRangeStep;
  return scale == Scale::kLog ? std::exp(free) : 1 / (1 + std::exp(-free));
}

Optimum maximise(const LogLikelihood& f, const std::vector<double>& start, double step,
                 int budget) {
  Optimum first = simplex(f, start, step, budget);
  const int left = budget - first.evaluations;
  if (left <= static_cast<int>(start.size()) + 1) return first;
  Optimum second = simplex(f, first.at, step / 4, left);
  second.evaluations += first.evaluations;
  return second;
}

Estimate profile_interval(const LogLikelihood& f, const Optimum& best, std::size_t i, Scale scale) {
  return {from_free(best.at[i], scale), from_free(end_of_profile(f, best, i, -1), scale),
          from_free(end_of_profile(f, best, i, 1), scale)};
}

std::vector<Estimate> curvature_intervals(const LogLikelihood& f, Optimum& best,
                                          const std::vector<Scale>& scales) {
  const auto n = static_cast<Eigen::Index>(scales.size());
  const auto shifted = [&](std::initializer_list<std::pair<Eigen::Index, double>> by) {
    std::vector<double> x = best.at;
    for (const auto& [i, d] : by) x[static_cast<std::size_t>(i)] += d;
    ++best.evaluations;
    return f(x);
  };
  Eigen::VectorXd step(n), up(n), down(n);
  Eigen::MatrixXd information(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    step[i] = 0.05;
    while (true) {
      up[i] = shifted({{i, step[i]}}), down[i] = shifted({{i, -step[i]}});
      const double loss = best.value - (up[i] + down[i]) / 2;
      information(i, i) = std::max(loss, 0.0) * 2 / (step[i] * step[i]);
      if (loss > 0.5 || step[i] >= kReach / 4) break;
      step[i] *= 2;
    }
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double both = shifted({{i, step[i]}, {j, step[j]}});
      information(i, j) = information(j, i) =
          -(both - up[i] - up[j] + best.value) / (step[i] * step[j]);
    }
  // Where the data say nothing, the free scale's reach does.
  const double least = std::pow(kDeviations / kReach, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  const Eigen::VectorXd precise = solver.eigenvalues().cwiseMax(least).cwiseInverse();
  const Eigen::MatrixXd covariance =
      solver.eigenvectors() * precise.asDiagonal() * solver.eigenvectors().transpose();
  std::vector<Estimate> estimates;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double half = std::min(kReach, kDeviations * std::sqrt(covariance(i, i)));
    estimates.push_back({from_free(best.at[k], scales[k]), from_free(best.at[k] - half, scales[k]),
                         from_free(best.at[k] + half, scales[k])});
  }
  return estimates;
}

}  // namespace anchord::tuning
