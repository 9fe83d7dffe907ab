#pragma once

#include <functional>
#include <vector>

#include "tools/anchor_tune/estimate.h"

namespace anchord::tuning {

/// What a parameter may be, and the scale on which it is free: `to_free` takes (0, infinity) or
/// (0, 1) to the real line, leaves what is on it, or takes what a metre changes to what kRangeStep
/// metres do.
enum class Scale { kLog, kLogit, kFree, kPerMetre };
inline constexpr double kRangeStep = 10;  ///< m, of a first step of a search
double to_free(double value, Scale scale);
double from_free(double free, Scale scale);

/// A log-likelihood of parameters on their free scale.
using LogLikelihood = std::function<double(const std::vector<double>&)>;

struct Optimum {
  std::vector<double> at;
  double value = 0;
  int evaluations = 0;
};

/// The greatest value by the simplex of Nelder and Mead (1965), from `start` with first steps of
/// `step` each; restarted once where it ended. Deterministic. At most about `budget` evaluations.
Optimum maximise(const LogLikelihood& f, const std::vector<double>& start, double step, int budget);

/// Where the profile likelihood of parameter i, the others at their best, falls 1.92 below the
/// optimum (half the 95 % quantile of chi-squared with one degree of freedom), on the parameter's
/// own scale. A side on which it does not fall so far within `kReach` ends there.
Estimate profile_interval(const LogLikelihood& f, const Optimum& best, std::size_t i, Scale scale);
inline constexpr double kReach = 12;

/// The same for all parameters from the curvature at the optimum: finite differences over steps
/// that each cost about 1, which is robust against a likelihood that is rough on a finer scale.
/// Parameters that hardly matter get all of `kReach`. Adds what it evaluates to `best.evaluations`.
std::vector<Estimate> curvature_intervals(const LogLikelihood& f, Optimum& best,
                                          const std::vector<Scale>& scales);

}  // namespace anchord::tuning
