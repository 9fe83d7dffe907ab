#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace anchord::experiment {

/// Random numbers that are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : bits_(seed) {}
  /// In (0, 1).
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }
  double uniform(double from, double to) { return from + (to - from) * uniform(); }
  /// Mean 0, variance 1 (Box and Muller 1958; one of the pair is enough).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  bool happens(double probability) { return uniform() < probability; }

 private:
  std::mt19937_64 bits_;
};

}  // namespace anchord::experiment
