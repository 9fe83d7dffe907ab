#pragma once

#include <optional>
#include <vector>

#include "tools/anchor_tune/estimate.h"

namespace anchord::tuning {

struct JudgedScore {
  double p = 0.5;  ///< as it was reported
  bool right = false;
  double range = 0;  ///< m
};

/// A logistic recalibration: logit p' = a + b logit p + per_m range. A score that says the share of
/// right ones among detections like it has a = 0, b = 1, per_m = 0.
struct Calibration {
  Estimate a, b;
  std::optional<Estimate> per_m;  ///< where the Bayesian information criterion prefers it
  double gain = 0;                ///< in log-likelihood, over the scores as they are
  bool off = false;               ///< the same prefers it to the scores as they are
};

/// The most likely one (Platt 1999, on the logit), with profile intervals. Nothing unless there are
/// right and false ones of more than one score.
std::optional<Calibration> calibrate(const std::vector<JudgedScore>& scores);

}  // namespace anchord::tuning
