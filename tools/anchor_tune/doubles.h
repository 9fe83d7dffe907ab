#pragma once

#include <optional>

#include "tools/anchor_tune/estimate.h"
#include "tools/anchor_tune/matching.h"

namespace anchord::tuning {

/// What a sensor reports twice in a frame.
struct Doubles {
  Estimate often;      ///< Sensor::double_detection
  double repeats = 0;  ///< detections that are expected to be repeats
  std::int64_t detections = 0;
};

/// The most likely rate of repeats: of two detections of a frame that are not both right, the less
/// sure one repeats the other, as the engine has it (repeat_density()), or the false one is there
/// by chance, which has an even `density` (per m^dims). Nothing where the Bayesian information
/// criterion prefers none.
std::optional<Doubles> fit_doubles(const Judgement& judgement, int sensor, double density,
                                   int dims);

}  // namespace anchord::tuning
