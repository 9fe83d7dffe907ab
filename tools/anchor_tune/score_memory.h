#pragma once

#include <optional>
#include <vector>

#include "tools/anchor_tune/estimate.h"

namespace anchord::tuning {

/// The scores of one thing over time.
struct ScoreSeries {
  std::vector<double> seconds, log_odds;
};

double log_odds(double score);

/// How alike the scores of one thing are, given what it is: ScoreMemory.
struct ScoreLikeness {
  Estimate share, seconds;
  int scores = 0;
};

/// The most likely one: log-odds, made to have mean 0 and variance 1, as a part that lasts
/// (Ornstein and Uhlenbeck's process) and one that does not; by a Kalman filter's innovations.
/// Nothing where the Bayesian information criterion prefers independent scores. Intervals from the
/// curvature.
std::optional<ScoreLikeness> fit_score_memory(const std::vector<ScoreSeries>& series);

}  // namespace anchord::tuning
