#include "tools/anchor_tune/scores.h"

#include <algorithm>
#include <cmath>

#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {
namespace {

constexpr double kLeastScore = 1e-6;  // as the engine clamps them

struct Sample {
  double logit, range;
  bool right;
};

/// ln P(right or false), b = exp(x[1]).
double log_likelihood(const std::vector<Sample>& samples, const std::vector<double>& x) {
  const double b = std::exp(x[1]), c = x.size() > 2 ? x[2] : 0;
  double total = 0;
  for (const Sample& s : samples) {
    const double log_odds = x[0] + b * s.logit + c * s.range;
    const double t = s.right ? -log_odds : log_odds;
    total -= t > 0 ? t + std::log1p(std::exp(-t)) : std::log1p(std::exp(t));
  }
  return total;
}

}  // namespace

std::optional<Calibration> calibrate(const std::vector<JudgedScore>& scores) {
  std::vector<Sample> samples;
  std::size_t right = 0;
  for (const JudgedScore& s : scores) {
    samples.push_back({to_free(std::clamp(s.p, kLeastScore, 1 - kLeastScore), Scale::kLogit),
                       s.range / kRangeStep, s.right});
    right += s.right ? 1 : 0;
  }
  const auto varied = [&](double Sample::*of) {
    return std::any_of(samples.begin(), samples.end(),
                       [&](const Sample& s) { return s.*of != samples.front().*of; });
  };
  if (!varied(&Sample::logit) || right == 0 || right == scores.size()) return std::nullopt;
  const auto f = [&](const std::vector<double>& x) { return log_likelihood(samples, x); };
  const double criterion = std::log(static_cast<double>(scores.size())) / 2;  // per parameter
  Optimum best = maximise(f, {0, 0}, 0.3, 400);
  const double as_it_is = f({0, 0});
  Calibration result;
  result.off = best.value - as_it_is > 2 * criterion;
  if (varied(&Sample::range)) {
    const Optimum with_range = maximise(f, {best.at[0], best.at[1], 0}, 0.3, 600);
    if (with_range.value - best.value > criterion) {
      best = with_range;
      result.per_m = profile_interval(f, best, 2, Scale::kPerMetre);
      result.off = result.off || best.value - as_it_is > 3 * criterion;
    }
  }
  result.a = profile_interval(f, best, 0, Scale::kFree);
  result.b = profile_interval(f, best, 1, Scale::kLog);
  result.gain = best.value - as_it_is;
  return result;
}

}  // namespace anchord::tuning
