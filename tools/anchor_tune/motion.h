#pragma once

#include <optional>
#include <vector>

#include "knowledge/knowledge.h"
#include "tools/anchor_tune/estimate.h"
#include "tools/anchor_tune/matching.h"

namespace anchord::tuning {

/// One object's right detections in order of time.
struct MeasuredTrack {
  std::vector<double> seconds;  ///< since its first
  std::vector<Gaussian> positions;
};
std::vector<MeasuredTrack> tracks_of(const Judgement& judgement, int object_class);

/// How objects of a class move.
struct Motion {
  Estimate psd;                        ///< as the model's kind has it
  Estimate initial_velocity_variance;  ///< constant_velocity only, (m/s)^2
  std::optional<Estimate> vertical;    ///< in 3-D: what height has of both
  int detections = 0, tracks = 0;
  int gaps = 0;    ///< steps of over one and a half times the median
  int strays = 0;  ///< gross errors among the detections

  /// A model of the kind that was fitted, with these numbers.
  BehaviourModel applied_to(BehaviourModel model) const;
};

/// Flags of detections, per track.
using Strays = std::vector<std::vector<char>>;

/// Innovations as the Kalman filter of a model has them (models/kinematic.h), each from where the
/// model says with probability `gate_probability` and else from anywhere within `radius` m: a gross
/// error must not pass for agility.
struct Innovations {
  double log_likelihood = 0;  ///< ln p(tracks), from the second detection of each on
  Strays strays;              ///< those more probably from anywhere
};
/// `left_out` (empty: none) are not used to update: fixed, for the likelihood to be smooth.
Innovations innovations(const std::vector<MeasuredTrack>& tracks, const Strays& left_out,
                        const BehaviourModel& model, double gate_probability, double radius,
                        int dims);

/// The most likely parameters, with profile intervals; nothing without a track of two detections.
/// Gaps in a track are predicted over; gross errors are left out, as those that the fit before
/// found to be. `model` says the kind, and where to start.
std::optional<Motion> fit_motion(const std::vector<MeasuredTrack>& tracks,
                                 const BehaviourModel& model, double gate_probability,
                                 double radius, int dims);

}  // namespace anchord::tuning
