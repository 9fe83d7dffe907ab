#include "maintenance/way.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maintenance/viewpoint.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

const std::vector<Wall> kCross{{{5, 0}, {5, 4}}};  // a wall from the lower edge, open above

WayMap map_of(const std::vector<Wall>& walls) { return {walls, 0.3, {0, 0}, {10, 10}}; }

TEST(WayMap, WithoutAWallInBetweenTheWayIsStraight) {
  const WayMap ways = map_of(kCross);
  const Way way = ways.way(ways.start({1, 9}), {9, 9});
  EXPECT_EQ(way.points.size(), 2u);
  EXPECT_DOUBLE_EQ(way.length, 8);
}

TEST(WayMap, GoesAroundTheEndOfAWallAndKeepsClear) {
  const WayMap ways = map_of(kCross);
  const Way way = ways.way(ways.start({3, 1}), {7, 1});
  // Over (4.7, 4.3) and (5.3, 4.3), the nodes at the wall's upper end.
  EXPECT_NEAR(way.length, 2 * std::hypot(1.7, 3.3) + 0.6, 1e-9);
  ASSERT_EQ(way.points.size(), 4u);
  double sum = 0;
  for (std::size_t i = 1; i < way.points.size(); ++i) {
    sum += (way.points[i] - way.points[i - 1]).norm();
    EXPECT_FALSE(ways.walls().between(way.points[i - 1], way.points[i]));
  }
  EXPECT_NEAR(sum, way.length, 1e-9);
}

TEST(WayMap, ThereIsNoWayIntoAClosedRoom) {
  const WayMap ways =
      map_of({{{2, 2}, {4, 2}}, {{4, 2}, {4, 4}}, {{4, 4}, {2, 4}}, {{2, 4}, {2, 2}}});
  EXPECT_TRUE(std::isinf(ways.length(ways.start({1, 1}), {3, 3})));
  EXPECT_TRUE(std::isfinite(ways.length(ways.start({1, 1}), {5, 5})));
}

TEST(WayMap, LengthsAreTheSameBothWays) {
  const WayMap ways = map_of({{{5, 0}, {5, 4}}, {{5, 5}, {5, 10}}, {{0, 5}, {3.5, 5}}});
  const Eigen::Vector2d a(1, 1), b(1, 9), c(9, 9);
  EXPECT_NEAR(ways.length(ways.start(a), b), ways.length(ways.start(b), a), 1e-9);
  EXPECT_NEAR(ways.length(ways.start(a), c), ways.length(ways.start(c), a), 1e-9);
  EXPECT_GT(ways.length(ways.start(b), c), 8);
}

TEST(Course, LooksEveryStepAndWhenItIsThere) {
  RoomOptions options;
  options.maintenance = R"("speed": 0.5, "step": 1)";
  options.verification = R"("dwell": 1.5)";
  const Site site{room(options)};
  Course course;
  follow({{{0, 1}, {1, 1}, {1, 1.75}}, 1.75}, {0, 0, {{1, 1.75}, 3, 0}, false}, 10, site, course);
  // The way takes 3.5 s; the looks of the second second and of the third lie on either piece.
  ASSERT_EQ(course.looks.size(), 6u);
  const double times[] = {11, 12, 13, 13.5, 14.5, 15};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(course.looks[i].time, times[i], 1e-9) << i;
  EXPECT_NEAR((course.looks[0].base.position - Eigen::Vector2d(0.5, 1)).norm(), 0, 1e-9);
  EXPECT_NEAR((course.looks[2].base.position - Eigen::Vector2d(1, 1.5)).norm(), 0, 1e-9);
  EXPECT_NEAR(course.looks[2].base.yaw, M_PI / 2, 1e-9);
  EXPECT_EQ(course.looks[3].base.yaw, 3);
  EXPECT_NEAR(course.end, 15, 1e-9);
}

}  // namespace
}  // namespace anchord
