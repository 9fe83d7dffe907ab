#pragma once

#include <vector>

#include "tools/anchor_tune/estimate.h"

namespace anchord::tuning {

/// One look at an object that was in view.
struct Glance {
  double seconds = 0;  ///< since the object's look before; 0 for its first
  int sensor = 0;
  bool found = false;
};

/// The looks at each object, in order of time.
using Glances = std::vector<std::vector<Glance>>;

/// How an object is found or missed: while it is visible with p_D, while it is hidden never; it
/// hides and shows itself at constant rates. Without `hidden` it is always visible.
struct Detectability {
  std::vector<Estimate> detection_probability;  ///< per sensor
  bool hidden = false;
  Estimate hide, show;  ///< 1/s
  double gain = 0;      ///< in log-likelihood, of the hidden state over none
};

/// ln P(found and missed) of a chain in continuous time that starts in its stationary state; the
/// forward recursion (Rabiner 1989), exact for any gaps between the looks.
double log_likelihood(const Glances& glances, const std::vector<double>& detection_probability,
                      double hide, double show);

/// The most likely of both: what Baum and Welch's iteration converges to, found by climbing the
/// likelihood itself, so that looks need not be evenly spaced. A hidden state is taken where the
/// Bayesian information criterion prefers it (two parameters more). Intervals: Clopper and
/// Pearson's without, the profile likelihood's with it. A sensor without looks gets 0 to 1.
Detectability fit_detectability(const Glances& glances, int sensors);

}  // namespace anchord::tuning
