#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace anchord::enumeration {

/// Distributions of our own: the library's differ between standard libraries.
class Dice {
 public:
  explicit Dice(std::mt19937_64& random) : random_(random) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  /// For scales: uniform in the logarithm.
  double scale(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  /// Uniform in low .. high, both possible.
  int integer(int low, int high) {
    return std::min(high, low + static_cast<int>(uniform(0, high - low + 1)));
  }
  bool chance(double p) { return uniform(0, 1) < p; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
    return radius * std::cos(2 * std::numbers::pi * uniform(0, 1));
  }
  template <typename T>
  const T& pick(const std::vector<T>& from) {
    return from[integer(0, static_cast<int>(from.size()) - 1)];
  }
  std::vector<double> distribution(std::size_t n, double least) {
    std::vector<double> p(n);
    double sum = 0;
    for (double& x : p) sum += x = uniform(least, 1);
    for (double& x : p) x /= sum;
    return p;
  }

 private:
  std::mt19937_64& random_;
};

}  // namespace anchord::enumeration
