#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/anchor_tune/matching.h"

namespace anchord::tuning {

/// How objects of a class come and go, from the truth of what is in view.
struct Turnover {
  std::vector<Eigen::Vector3d> arrivals;  ///< where, of those that came where it had been looked
  double exposure = 0;                    ///< m^dims s of looking where it had been looked
  double seconds = 0;                     ///< of looking, after the first frame of a recording
  int there = 0;                          ///< met where nobody had looked before
  double new_volume = 0;                  ///< m^dims that came into view
  int ends = 0;                           ///< objects that were gone before the recording was
  double object_seconds = 0;
};
Turnover turnover_of(const Judgement& judgement, int object_class);

/// A place where objects come in.
struct Gate {
  double share = 0;  ///< of the arrivals
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Arrivals as a mixture of normal densities and a uniform one over `volume` (m^dims), by
/// expectation and maximisation (Dempster, Laird, Rubin 1977): of up to `most` components, as many
/// as the Bayesian information criterion wants; each starts at the arrival that the others explain
/// worst. Deviations are kept above `least` (m). The uniform share is what is left of 1.
std::vector<Gate> fit_gates(const std::vector<Eigen::Vector3d>& arrivals, double volume, int most,
                            double least, int dims);

}  // namespace anchord::tuning
