#include "mht/marginals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace anchord {
namespace {

/// Exact probabilities by trying every association.
std::vector<double> exact(const ScratchVector<Pairing>& pairings, int tracks, int detections) {
  std::vector<double> sums(pairings.size(), 0.0);
  std::vector<char> used(detections, 0);
  std::vector<std::size_t> chosen;
  double total = 0;
  const auto recurse = [&](const auto& self, int track, double weight) -> void {
    if (track == tracks) {
      total += weight;
      for (const std::size_t e : chosen) sums[e] += weight;
      return;
    }
    self(self, track + 1, weight);
    for (std::size_t e = 0; e < pairings.size(); ++e) {
      if (pairings[e].track != track || used[pairings[e].detection]) continue;
      used[pairings[e].detection] = 1;
      chosen.push_back(e);
      self(self, track + 1, weight * pairings[e].weight);
      chosen.pop_back();
      used[pairings[e].detection] = 0;
    }
  };
  recurse(recurse, 0, 1);
  for (double& sum : sums) sum /= total;
  return sums;
}

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

TEST(Marginals, AreExactWithoutLoops) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    // A chain: track i may give detections i and i + 1.
    ScratchVector<Pairing> pairings;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 2; ++j)
        pairings.push_back({i, i + j, std::exp(10 * uniform(random) - 3), 0});
    const auto expected = exact(pairings, 5, 6);
    estimate_probabilities(pairings, 5, 6);
    for (std::size_t e = 0; e < pairings.size(); ++e)
      // Messages are taken as settled when they change by a thousandth.
      ASSERT_NEAR(pairings[e].probability, expected[e], 5e-3) << "trial " << trial << ' ' << e;
  }
}

TEST(Marginals, WithLoopsTellLikelyFromUnlikely) {
  std::mt19937_64 random(2);
  double worst = 0, missed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    ScratchVector<Pairing> pairings;
    for (int track = 0; track < 4; ++track)
      for (int z = 0; z < 4; ++z)
        if (random() % 3 > 0) pairings.push_back({track, z, std::exp(12 * uniform(random) - 4), 0});
    const auto expected = exact(pairings, 4, 4);
    estimate_probabilities(pairings, 4, 4);
    count_exchanges(pairings, 4, 4);
    for (std::size_t e = 0; e < pairings.size(); ++e) {
      worst = std::max(worst, std::abs(pairings[e].probability - expected[e]));
      if (pairings[e].probability < 1e-4) missed = std::max(missed, expected[e]);
    }
  }
  // Near certain pairings in a loop are where belief propagation errs most.
  EXPECT_LT(worst, 0.4);
  // So dense and so extreme, what is said to be negligible may be some ten times that.
  EXPECT_LT(missed, 1e-2);
}

TEST(Marginals, OfTwoThatMayExchangeAreNotAllForTheBetter) {
  for (const double odds : {0.001, 0.04, 0.5, 1.0}) {
    const double weight = 1e4;  // neither is missed
    ScratchVector<Pairing> pairings{
        {0, 0, weight, 0}, {0, 1, weight * odds, 0}, {1, 0, weight, 0}, {1, 1, weight, 0}};
    const auto expected = exact(pairings, 2, 2);
    estimate_probabilities(pairings, 2, 2);
    count_exchanges(pairings, 2, 2);
    // Whether there is an exchange is what is asked, not how probable it is to the percent.
    for (std::size_t e = 0; e < pairings.size(); ++e)
      EXPECT_GT(pairings[e].probability, 0.3 * expected[e]) << odds << ' ' << e;
  }
}

}  // namespace
}  // namespace anchord
