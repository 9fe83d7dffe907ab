#pragma once

#include <optional>
#include <vector>

#include "tools/anchor_tune/estimate.h"

namespace anchord::tuning {

struct JudgedScore {
  double p = 0.5;  ///< as it was reported
  bool right = false;
};

/// A logistic recalibration: logit p' = a + b logit p. A score that says the share of right ones
/// among detections like it has a = 0, b = 1.
struct Calibration {
  Estimate a, b;
  double gain = 0;   ///< in log-likelihood, over the scores as they are
  bool off = false;  ///< the Bayesian information criterion prefers it to the scores as they are
};

/// The most likely one (Platt 1999, on the logit), with profile intervals. Nothing unless there are
/// right and false ones of more than one score.
std::optional<Calibration> calibrate(const std::vector<JudgedScore>& scores);

}  // namespace anchord::tuning
