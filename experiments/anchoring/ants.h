#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/frame.h"
#include "experiments/dice.h"
#include "knowledge/knowledge.h"

namespace anchord::experiment {

/// Ants in a dish, seen from above as blobs that merge (thesis section 2.6.3). Speeds and sizes are
/// those of clonal raider ants in the videos of anTraX (Gal, Saragosti, Kronauer, eLife 2020): half
/// of the steps of a tenth of a second are shorter than 0.4 mm, 99 % shorter than 1.2 mm.
struct Dish {
  int ants = 20;
  double radius = 0.033, body = 0.003;           ///< m; of the dish, length of an ant
  double seconds = 60, rate_hz = 10;             ///< of the recording
  double speed = 0.004, speed_deviation = 0.47;  ///< m/s, its median; of its logarithm
  double speed_time = 1;                         ///< s, after which it is another
  double turning = 0.6;                          ///< rad/s^0.5, of the heading's random walk
  double least_diameter = 0.0016, most_diameter = 0.0021;  ///< m, of the disc with an ant's area
  double noise = 1e-4, size_noise = 0.06;  ///< m per axis; of a size, relative to it
  double detection_probability = 0.99;
};

/// One frame, and where the ants are.
struct AntsShot {
  double time = 0;  ///< s
  Frame frame;
  std::vector<Eigen::Vector2d> truth;
};

/// Ants are random walkers that turn round at the dish's edge. Those that are linked by steps
/// shorter than a body's length give one blob, at their middle, with the area of all.
std::vector<AntsShot> simulate_ants(const Dish& dish, Dice& dice);

struct AntsBelief {
  double expected = 0;  ///< number of objects, over all hypotheses
  int shown = 0;        ///< in the best world
  /// Per ant, the birth of the anchor that it is paired with, or -1, as CLEAR-MOT pairs them.
  std::vector<std::int64_t> names;
};

std::vector<AntsBelief> watch_ants(const Knowledge& knowledge, const std::vector<AntsShot>& shots);

}  // namespace anchord::experiment
