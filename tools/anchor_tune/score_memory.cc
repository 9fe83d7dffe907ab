#include "tools/anchor_tune/score_memory.h"

#include <algorithm>
#include <cmath>

#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {
namespace {

/// The same with mean 0 and variance 1 over all; nothing where they do not vary.
std::vector<ScoreSeries> standardised(std::vector<ScoreSeries> all) {
  double n = 0, sum = 0, squares = 0;
  for (const ScoreSeries& s : all)
    for (const double x : s.log_odds) ++n, sum += x;
  const double mean = sum / n;
  for (const ScoreSeries& s : all)
    for (const double x : s.log_odds) squares += (x - mean) * (x - mean);
  if (!(squares > 0)) return {};
  const double scale = std::sqrt(n / squares);
  for (ScoreSeries& s : all)
    for (double& x : s.log_odds) x = scale * (x - mean);
  return all;
}

double log_likelihood(const std::vector<ScoreSeries>& all, double share, double seconds) {
  double sum = 0;
  for (const ScoreSeries& series : all) {
    double mean = 0, variance = share;
    for (std::size_t i = 0; i < series.seconds.size(); ++i) {
      if (i > 0) {
        const double kept = std::exp(-(series.seconds[i] - series.seconds[i - 1]) / seconds);
        mean *= kept;
        variance = kept * kept * variance + (1 - kept * kept) * share;
      }
      const double all_of_it = variance + 1 - share, news = series.log_odds[i] - mean;
      sum -= 0.5 * (std::log(all_of_it) + news * news / all_of_it);
      mean += variance / all_of_it * news;
      variance *= 1 - variance / all_of_it;
    }
  }
  return sum;
}

}  // namespace

double log_odds(double score) {
  const double p = std::clamp(score, 1e-6, 1 - 1e-6);
  return std::log(p) - std::log1p(-p);
}

std::optional<ScoreLikeness> fit_score_memory(const std::vector<ScoreSeries>& series) {
  const std::vector<ScoreSeries> all = standardised(series);
  ScoreLikeness out;
  for (const ScoreSeries& s : all) out.scores += static_cast<int>(s.log_odds.size());
  if (out.scores == 0) return std::nullopt;
  const auto f = [&](const std::vector<double>& x) {
    return log_likelihood(all, from_free(x[0], Scale::kLogit), std::exp(x[1]));
  };
  Optimum best = maximise(f, {0, 0}, 1, 300);
  if (best.value - log_likelihood(all, 0, 1) < std::log(out.scores)) return std::nullopt;
  const auto intervals = curvature_intervals(f, best, {Scale::kLogit, Scale::kLog});
  out.share = intervals[0];
  out.seconds = intervals[1];
  return out;
}

}  // namespace anchord::tuning
