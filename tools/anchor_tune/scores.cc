#include "tools/anchor_tune/scores.h"

#include <algorithm>
#include <cmath>

#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {
namespace {

constexpr double kLeastScore = 1e-6;  // as the engine clamps them

/// ln P(right or false), b = exp(x[1]).
double log_likelihood(const std::vector<std::pair<double, bool>>& logits,
                      const std::vector<double>& x) {
  const double b = std::exp(x[1]);
  double total = 0;
  for (const auto& [logit, right] : logits) {
    const double t = right ? -(x[0] + b * logit) : x[0] + b * logit;
    total -= t > 0 ? t + std::log1p(std::exp(-t)) : std::log1p(std::exp(t));
  }
  return total;
}

}  // namespace

std::optional<Calibration> calibrate(const std::vector<JudgedScore>& scores) {
  std::vector<std::pair<double, bool>> logits;
  std::size_t right = 0;
  for (const JudgedScore& s : scores) {
    logits.emplace_back(to_free(std::clamp(s.p, kLeastScore, 1 - kLeastScore), Scale::kLogit),
                        s.right);
    right += s.right ? 1 : 0;
  }
  const bool varied = std::any_of(logits.begin(), logits.end(),
                                  [&](const auto& l) { return l.first != logits.front().first; });
  if (!varied || right == 0 || right == scores.size()) return std::nullopt;
  const auto f = [&](const std::vector<double>& x) { return log_likelihood(logits, x); };
  const Optimum best = maximise(f, {0, 0}, 0.3, 400);
  Calibration result;
  // `a` is free as it is: the logarithm of what profile_interval() gives.
  const Estimate a = profile_interval(f, best, 0, Scale::kLog);
  result.a = {std::log(a.value), std::log(a.low), std::log(a.high)};
  result.b = profile_interval(f, best, 1, Scale::kLog);
  result.gain = best.value - f({0, 0});
  result.off = result.gain > std::log(static_cast<double>(scores.size()));
  return result;
}

}  // namespace anchord::tuning
