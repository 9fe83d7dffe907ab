#include "mht/assignment.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace anchord {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The least cost by trying everything.
double least(const std::vector<double>& cost, int detections, int leaves) {
  std::vector<char> used(leaves, 0);
  const auto recurse = [&](const auto& self, int z) -> double {
    if (z == detections) return 0;
    const double* row = &cost[z * (leaves + 1)];
    double best = row[leaves] + self(self, z + 1);
    for (int l = 0; l < leaves; ++l) {
      if (used[l]) continue;
      used[l] = 1;
      best = std::min(best, row[l] + self(self, z + 1));
      used[l] = 0;
    }
    return best;
  };
  return recurse(recurse, 0);
}

struct Random {
  std::mt19937_64 engine;
  double real(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

TEST(Assignment, IsTheCheapest) {
  Random random{std::mt19937_64(3)};
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = 1 + static_cast<int>(random.engine() % 6), m = random.engine() % 6;
    std::vector<double> cost;
    for (int i = 0; i < n * (m + 1); ++i)
      cost.push_back(i % (m + 1) == m           ? random.real(-1, 1)
                     : random.engine() % 4 == 0 ? kInfinite
                                                : random.real(-10, 5));
    Assignment assignment(n, m);
    assignment.solve(cost);
    ASSERT_NEAR(assignment.cost(cost), least(cost, n, m), 1e-9) << "trial " << trial;
  }
}

TEST(Assignment, GoesOnToTheCheapestAfterLosingPairsAndItsBoundHolds) {
  Random random{std::mt19937_64(4)};
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = 1 + static_cast<int>(random.engine() % 5), m = 1 + random.engine() % 5;
    std::vector<double> cost;
    for (int i = 0; i < n * (m + 1); ++i)
      cost.push_back(i % (m + 1) == m ? 0 : random.real(-10, 5));
    Assignment assignment(n, m);
    assignment.solve(cost);
    const RowFlags none_fixed(n, 0);
    for (int step = 0; step < 6; ++step) {
      const int z = static_cast<int>(random.engine() % n);
      const double bound = assignment.cost(cost) + assignment.least_loss(z, cost);
      cost[z * (m + 1) + assignment.choice(z)] = kInfinite;
      const double expected = least(cost, n, m);
      if (!assignment.reassign(z, cost, none_fixed)) {
        ASSERT_EQ(expected, kInfinite) << "trial " << trial;
        break;
      }
      ASSERT_NEAR(assignment.cost(cost), expected, 1e-9) << "trial " << trial << " " << step;
      ASSERT_LE(bound, expected + 1e-9) << "trial " << trial;
    }
  }
}

}  // namespace
}  // namespace anchord
