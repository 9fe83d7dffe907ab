#pragma once

#include <optional>
#include <vector>

#include "tools/anchor_tune/estimate.h"

namespace anchord::tuning {

/// One look at an object that was in view.
struct Glance {
  double seconds = 0;  ///< since the object's look before; 0 for its first
  int sensor = 0;
  bool found = false;
  double range = 0;  ///< from the sensor, m
};

/// The looks at each object, in order of time.
using Glances = std::vector<std::vector<Glance>>;

/// How an object is found or missed: while it is visible with p_D, while it is hidden never; it
/// hides and shows itself at constant rates. Without `hidden` it is always visible.
struct Detectability {
  std::vector<Estimate> detection_probability;  ///< per sensor; with per_m, near at hand
  std::optional<Estimate> per_m;                ///< by which logit p_D changes, for all sensors
  double range_gain = 0;                        ///< in log-likelihood, of per_m over none
  bool range_pays = false;  ///< whether the criterion prefers per_m, taken or not
  bool hidden = false;
  Estimate hide, show;  ///< 1/s
  double gain = 0;      ///< in log-likelihood, of the hidden state over none
};

/// ln P(found and missed) of a chain in continuous time that starts in its stationary state; the
/// forward recursion (Rabiner 1989), exact for any gaps between the looks.
double log_likelihood(const Glances& glances, const std::vector<double>& detection_probability,
                      double hide, double show, double per_m = 0);

/// The most likely of all: what Baum and Welch's iteration converges to, found by climbing the
/// likelihood itself, so that looks need not be evenly spaced. A hidden state, and if it may be
/// `ranged` a p_D that changes with the distance, are taken where the Bayesian information
/// criterion prefers them (two parameters more, and one). Intervals: Clopper and Pearson's without
/// either, else the profile likelihood's. A sensor without looks gets 0 to 1.
Detectability fit_detectability(const Glances& glances, int sensors, bool ranged);

}  // namespace anchord::tuning
