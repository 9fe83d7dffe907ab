#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "maintenance/gain.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

constexpr double kNoise = 0.01;  // of the room's eye, m^2

/// The mean over many runs of ln(P without / P), each look detecting by a throw of dice, and how
/// far it may be off.
struct Sampled {
  double gain = 0, deviation = 0;
};
Sampled sample(double variance, double psd, double q, int looks, double step, int runs) {
  std::mt19937_64 dice(7);
  std::uniform_real_distribution<double> uniform;
  double sum = 0, squares = 0;
  for (int run = 0; run < runs; ++run) {
    double p = variance, free = variance;
    for (int k = 0; k < looks; ++k) {
      p += psd * step;
      free += psd * step;
      if (uniform(dice) < q) p = p * kNoise / (p + kNoise);
    }
    const double gain = std::log(free / p);
    sum += gain;
    squares += gain * gain;
  }
  const double mean = sum / runs;
  return {mean, std::sqrt((squares / runs - mean * mean) / runs)};
}

TEST(GainBound, LooksThatMayMissGainAtLeastWhatIsSaid) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  for (const double q : {0.2, 0.5, 0.9})
    for (const double psd : {0.0, 0.01, 0.3})
      for (const int count : {2, 5, 15}) {
        const std::vector<Subject> subjects{with_q(cup("c", 5, 5, 0.5, knowledge, psd), q)};
        std::vector<Glance> looks;
        for (int k = 1; k <= count; ++k) looks.push_back({0, {{4, 5}, 0, 0}, 0.5 * k});
        const double bound = expected_gain(subjects, looks, 0.5 * count, site);
        const Sampled truth = sample(0.5, psd, q, count, 0.5, 20'000);
        // Four deviations of the sampled mean: one failure in 30,000 by chance, and the seed is
        // fixed.
        EXPECT_LE(bound, truth.gain + 4 * truth.deviation) << q << ' ' << psd << ' ' << count;
        EXPECT_GE(bound, 0.6 * truth.gain) << q << ' ' << psd << ' ' << count;
      }
}

}  // namespace
}  // namespace anchord
