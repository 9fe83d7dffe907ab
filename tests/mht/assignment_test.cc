#include "mht/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/log_probability.h"

namespace anchord {
namespace {

/// The most gain by trying everything, without what is banned of the first free detection; those
/// before it are left out with the leaves that they keep.
double most(const PairGains& gains, int first, const Assignment::Banned& banned,
            std::vector<char> used) {
  const auto may = [&](int z, int choice) {
    return z != first || std::find(banned.begin(), banned.end(), choice) == banned.end();
  };
  const auto recurse = [&](const auto& self, int z) -> double {
    if (z == gains.detections()) return 0;
    double best = may(z, Assignment::kNone) ? self(self, z + 1) : kLogZero;
    for (const auto& [leaf, gain] : gains.of(z)) {
      if (used[leaf] || !may(z, leaf)) continue;
      used[leaf] = 1;
      best = std::max(best, gain + self(self, z + 1));
      used[leaf] = 0;
    }
    return best;
  };
  return recurse(recurse, first);
}

struct Random {
  std::mt19937_64 engine;
  double real(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

PairGains random_gains(Random& random, int most_detections, int most_leaves) {
  const int n = 1 + static_cast<int>(random.engine() % most_detections);
  const int m = static_cast<int>(random.engine() % (most_leaves + 1));
  PairGains gains(n, m);
  for (int z = 0; z < n; ++z) {
    gains.start_row();
    for (int leaf = 0; leaf < m; ++leaf)
      if (random.engine() % 4 != 0) gains.add(leaf, random.real(-5, 10));
  }
  return gains;
}

TEST(Assignment, GainsTheMost) {
  Random random{std::mt19937_64(3)};
  for (int trial = 0; trial < 5000; ++trial) {
    const PairGains gains = random_gains(random, 6, 6);
    const Assignment assignment(gains);
    // 1e-9: sums of at most six numbers of size 10.
    ASSERT_NEAR(assignment.gain(gains),
                most(gains, 0, {Assignment::kNone - 1}, std::vector<char>(gains.leaves(), 0)), 1e-9)
        << "trial " << trial;
  }
}

TEST(Assignment, ItsPricesProveIt) {
  Random random{std::mt19937_64(5)};
  for (int trial = 0; trial < 2000; ++trial) {
    const PairGains gains = random_gains(random, 6, 6);
    const Assignment assignment(gains);
    for (int z = 0; z < gains.detections(); ++z) {
      ASSERT_GE(assignment.slack_of_none(z), -1e-9);
      if (assignment.choice(z) == Assignment::kNone) {
        ASSERT_NEAR(assignment.slack_of_none(z), 0, 1e-9);
      }
      for (const auto& pair : gains.of(z)) {
        ASSERT_GE(assignment.slack(z, pair), -1e-9) << "trial " << trial;
        if (pair.leaf == assignment.choice(z)) {
          ASSERT_NEAR(assignment.slack(z, pair), 0, 1e-9);
        }
      }
    }
  }
}

/// As ranking does it: a detection loses choice after choice, then the next one while it keeps its
/// last.
TEST(Assignment, GoesOnToTheBestAfterLosingChoicesAndItsBoundHolds) {
  Random random{std::mt19937_64(4)};
  for (int trial = 0; trial < 5000; ++trial) {
    const PairGains gains = random_gains(random, 5, 5);
    Assignment assignment(gains);
    double kept = 0;  // what detections that keep their choice gain
    std::vector<char> used(gains.leaves(), 0);
    for (int z = 0; z < gains.detections(); ++z) {
      Assignment::Banned banned;
      for (int losses = static_cast<int>(random.engine() % 3); losses > 0; --losses) {
        banned.push_back(assignment.choice(z));
        const double before = assignment.gain(gains);
        const double bound = before - assignment.least_loss(z, banned, gains);
        const double expected = kept + most(gains, z, banned, used);
        Assignment next = assignment;
        if (!next.reassign(z, banned, gains)) {
          ASSERT_EQ(expected, kLogZero) << "trial " << trial;
          break;
        }
        ASSERT_NEAR(next.gain(gains), expected, 1e-9) << "trial " << trial << " detection " << z;
        ASSERT_GE(bound, expected - 1e-9) << "trial " << trial;
        assignment = next;
      }
      if (assignment.choice(z) == Assignment::kNone) continue;
      used[assignment.choice(z)] = 1;
      for (const auto& [leaf, gain] : gains.of(z))
        if (leaf == assignment.choice(z)) kept += gain;
    }
  }
}

}  // namespace
}  // namespace anchord
