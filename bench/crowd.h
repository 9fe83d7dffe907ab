#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/frame.h"
#include "knowledge/knowledge.h"

namespace anchord::bench {

/// Seeded random numbers whose values do not depend on the standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double uniform(double low, double high);
  double normal(double deviation);
  bool chance(double p) { return uniform(0, 1) < p; }
  /// 0 .. count - 1
  std::size_t index(std::size_t count);

 private:
  std::mt19937_64 random_;
};

/// Like objects that nothing but their motion tells apart: constant velocity with white
/// acceleration, started uniformly in a square, free to leave it; detected with one clutter
/// detection per frame uniform over that square, in no order.
struct CrowdParameters {
  int objects = 20;
  double rate_hz = 30, duration_s = 20;
  double side_m = 20;
  double acceleration_psd = 0.01;  ///< m^2/s^3
  double speed_deviation = 0.3;    ///< m/s per axis, at the start
  double noise_deviation = 0.15;   ///< m per axis
  double detection_probability = 0.9;

  int frames() const { return static_cast<int>(rate_hz * duration_s); }
};

/// A simulated scene: what was detected, and where each object was (by object), per frame.
struct Crowd {
  std::vector<Frame> frames;
  std::vector<std::vector<Eigen::Vector2d>> truth;
};

Crowd simulate(const CrowdParameters& parameters, std::uint64_t seed);

/// What a configuration for such a scene says: its true noise, motion, detection probability and
/// clutter; few arrivals and departures; all limits at their defaults.
std::string crowd_configuration(const CrowdParameters& parameters);
Knowledge crowd_knowledge(const CrowdParameters& parameters);

}  // namespace anchord::bench
