#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "models/somewhere.h"
#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Areas are sums over some hundred cells.
constexpr double kRounding = 1e-12;

const Grid& world() {
  static const Grid grid = Grid::over({-1, -1, 0}, {5, 5, 3}, 0.25);
  return grid;
}

/// What of the one lies in the other too, m^dims over m^dims.
double shared(const Footprint& footprint, const Region& other) {
  const auto overlap = footprint.overlap(other);
  return std::inner_product(overlap.begin(), overlap.end(), footprint.share.begin(), 0.0);
}

class FootprintIn : public testing::TestWithParam<int> {
 protected:
  const int dims = GetParam();
  Footprint of(const Region& region) const { return Footprint::of(region, world(), dims); }
};
INSTANTIATE_TEST_SUITE_P(Dimensions, FootprintIn, testing::Values(2, 3));

TEST_P(FootprintIn, SharesSumToOne) {
  std::mt19937_64 random(5);
  Dice dice(random);
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector2d middle(dice.uniform(0, 4), dice.uniform(0, 4));
    Region region{{}, 0, 1};
    const int corners = dice.integer(3, 9);  // of a star, convex or not
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, r = dice.scale(0.05, 2);
      region.polygon.push_back(middle + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    if (dice.chance(0.5)) std::reverse(region.polygon.begin(), region.polygon.end());
    const Footprint f = of(region);
    EXPECT_NEAR(std::accumulate(f.share.begin(), f.share.end(), 0.0), 1, kRounding);
    EXPECT_DOUBLE_EQ(f.volume, region.volume(dims));
    for (std::size_t i = 0; i < f.cells.size(); ++i) {
      EXPECT_GT(f.share[i], 0);
      EXPECT_EQ(f.position_of[f.cells[i]], static_cast<int>(i));
    }
  }
}

TEST_P(FootprintIn, GridIsAlignedToTheWorlds) {
  const Footprint f = of(box({0.1, 0.6, 0}, {1.3, 2.2, 1}));
  for (const int cell : f.cells) {
    const Eigen::Vector3d corner = f.grid.corner_min(cell);
    const int there = world().index(corner + Eigen::Vector3d(0.01, 0.01, 0));
    EXPECT_TRUE(world().corner_min(there).head<2>().isApprox(corner.head<2>(), kRounding));
  }
}

TEST_P(FootprintIn, ARegionLiesInItself) {
  const Region l{{{0.1, 0.1}, {2.1, 0.1}, {2.1, 0.9}, {1.1, 0.9}, {1.1, 2.3}, {0.1, 2.3}}, 0.2, 1};
  EXPECT_NEAR(shared(of(l), l), 1, kRounding);
}

TEST_P(FootprintIn, NestedPlacesOverlapWhereverTheCellsEdgesAre) {
  // A shelf against the wall of a room, whose walls follow no cell's edge.
  const Region room = box({0.1, 0.1, 0}, {3.9, 3.7, 2.5}),
               shelf = box({3.4, 0.6, 0.3}, {3.9, 2, 2});
  EXPECT_NEAR(shared(of(shelf), room), 1, kRounding);
  const double part = shelf.volume(dims) / room.volume(dims);
  EXPECT_NEAR(shared(of(room), shelf), part, kRounding);
}

TEST_P(FootprintIn, DisjointPlacesDoNotOverlapThoughTheyShareCells) {
  const Region kitchen = box({0.1, 0.1, 0}, {1.9, 2, 2.5}),
               hall = box({1.9, 0.1, 0}, {3.1, 2, 2.5});
  EXPECT_NEAR(shared(of(kitchen), hall), 0, kRounding);
  EXPECT_NEAR(shared(of(hall), kitchen), 0, kRounding);
  EXPECT_EQ(shared(of(kitchen), box({3, 3, 0}, {4, 4, 1})), 0);
}

TEST_P(FootprintIn, AnLInARoomAndARoomInAnL) {
  const Region l{{{0.1, 0.1}, {2.1, 0.1}, {2.1, 0.9}, {1.1, 0.9}, {1.1, 2.3}, {0.1, 2.3}}, 0, 1};
  const Region room = box({0.1, 0.1, 0}, {3, 3, 1}), notch = box({0.6, 0.4, 0}, {1.6, 1.7, 1});
  const double in_common = 1.0 * 0.5 + 0.5 * 0.8;  // of the notch, by hand
  EXPECT_NEAR(shared(of(l), room), 1, kRounding);
  EXPECT_NEAR(shared(of(room), l), l.area() / room.area(), kRounding);
  EXPECT_NEAR(shared(of(notch), l), in_common / notch.area(), kRounding);
  EXPECT_NEAR(shared(of(l), notch), in_common / l.area(), kRounding);
}

TEST(Footprint, HeightsCountInThreeDimensionsOnly) {
  const Region low = box({0, 0, 0}, {1, 1, 1}), high = box({0, 0, 0.75}, {1, 1, 2});
  EXPECT_NEAR(shared(Footprint::of(low, world(), 3), high), 0.25, kRounding);
  EXPECT_NEAR(shared(Footprint::of(high, world(), 3), low), 0.2, kRounding);
  EXPECT_NEAR(shared(Footprint::of(low, world(), 2), high), 1, kRounding);
  EXPECT_EQ(shared(Footprint::of(low, world(), 3), box({0, 0, 1.5}, {1, 1, 2})), 0);
}

}  // namespace
}  // namespace anchord
