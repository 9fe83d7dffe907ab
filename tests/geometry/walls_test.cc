#include "geometry/walls.h"

#include <gtest/gtest.h>

#include <array>

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

TEST(Walls, WhatStandsInAColumnIsHiddenAsEachOfItsPointsIs) {
  const Walls walls({{{5, 0}, {5, 4}, 0, 1}, {{5.5, 0}, {5.5, 4}, 1.4, 2}, {{6, 3}, {9, 3}}});
  const std::array<double, 5> heights{-1, 0.3, 1.1, 1.8, 3};
  for (const double eye_height : {0.2, 1.5, 2.2})
    for (const Eigen::Vector2d& column : {Eigen::Vector2d{7, 2}, {7, 3.2}, {4.5, 2}, {5, 2}}) {
      const Eigen::Vector3d eye(4, 2, eye_height);
      int clear = 0;
      for (const double z : heights) clear += !walls.hide(eye, {column.x(), column.y(), z});
      EXPECT_EQ(walls.clear(eye, column, heights), clear) << eye_height << ": " << column;
    }
}

TEST(Walls, OfABoxAreThoseThatMayReachIntoIt) {
  const Walls walls({{{0, 0}, {4, 0}}, {{9, 9}, {9, 12}}});
  const Walls near = walls.within({1, -1, 2, 1});
  EXPECT_TRUE(near.between({1.5, -1}, {1.5, 1}));
  EXPECT_FALSE(near.between({8, 10}, {10, 10}));
  EXPECT_TRUE(walls.within({5, 5, 6, 6}).none());
}

}  // namespace
}  // namespace anchord
