#include "geometry/walls.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

const std::vector<Wall> kCross{{{5, 0}, {5, 4}}};

TEST(Walls, BlockWhatCrossesOrTouchesThem) {
  const Walls walls(kCross);
  EXPECT_TRUE(walls.between({4, 2}, {6, 2}));
  EXPECT_TRUE(walls.between({4, 2}, {5, 2}));
  EXPECT_TRUE(walls.between({5, 3}, {5, 9}));
  EXPECT_FALSE(walls.between({5, 5}, {5, 9}));
  EXPECT_FALSE(walls.between({4, 5}, {6, 5}));
  EXPECT_FALSE(walls.between({4, 1}, {4, 3}));
}

TEST(Walls, HideWhatLiesFartherBehindThanTheirDepth) {
  const Walls walls(kCross);
  EXPECT_TRUE(walls.hide({4, 2, 0}, {6, 2, 0}));
  EXPECT_TRUE(walls.hide({4, 2, 0}, {5.11, 2, 0}));
  EXPECT_FALSE(walls.hide({4, 2, 0}, {5.09, 2, 0})) << "within 0.1 m";
  EXPECT_FALSE(walls.hide({4, 5, 0}, {6, 5, 0}));
  EXPECT_FALSE(walls.hide({4, 2, 0}, {4, 2, -3})) << "straight below the eye";
  EXPECT_FALSE(Walls({}).hide({4, 2, 0}, {6, 2, 0}));
}

TEST(Walls, ALowOneIsLookedOver) {
  const Walls walls({{{5, 0}, {5, 4}, 0, 1}});
  EXPECT_TRUE(walls.hide({4, 2, 0.5}, {6, 2, 0.5}));
  EXPECT_FALSE(walls.hide({4, 2, 1.5}, {6, 2, 1.5}));
  EXPECT_TRUE(walls.hide({4, 2, 1.5}, {6, 2, 0.3})) << "the line passes at 0.9 m";
  EXPECT_FALSE(walls.hide({4, 2, 1.5}, {6, 2, 0.7})) << "at 1.1 m";
  EXPECT_FALSE(walls.hide({4, 2, -1}, {6, 2, -1})) << "below it";
  EXPECT_TRUE(walls.between({4, 2}, {6, 2})) << "no way, whatever its height";
}

}  // namespace
}  // namespace anchord
