#include "maintenance/viewpoint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "knowledge/configuration.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

/// A solid room with a camera 1.2 m above the base, level, 0.99 x 0.75 rad, 0.5 to 4.5 m.
Knowledge solid_room() {
  return parse_configuration(R"({"world": {"bounds": {"min": [0, 0, 0], "max": [10, 10, 3]}},
    "sensors": {"camera": {"view": {"type": "frustum", "hfov": 0.99, "vfov": 0.75,
                                    "range": [0.5, 4.5]},
                           "noise": [0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01],
                           "verification": {"mount": {"position": [0.1, 0.2, 1.2]}}}}})")
      .knowledge();
}

TEST(Viewpoint, StandsInTheMiddleOfTheRangeOnTheRobotsSide) {
  const Site site{room()};
  const auto base = viewpoint_of({8, 5, 0}, site.eyes[0], {{1, 5}, 0, 0}, site);
  ASSERT_TRUE(base);
  EXPECT_NEAR(base->position.x(), 8 - 1.2, 1e-9);  // the middle of 0.4 .. 2 m
  EXPECT_NEAR(base->position.y(), 5, 1e-9);
}

TEST(Viewpoint, IsWhereTheRobotIsIfItSeesTheObjectFromThere) {
  const Site site{room()};
  const auto base = viewpoint_of({5, 5, 0}, site.eyes[0], {{5, 6.5}, 2, 0}, site);
  ASSERT_TRUE(base);
  EXPECT_EQ(base->position, Eigen::Vector2d(5, 6.5));
}

TEST(Viewpoint, GoesRoundWhereAWallIsBetween) {
  RoomOptions options;
  options.walls = "[[[7.5, 4], [7.5, 6]]]";
  const Site site{room(options)};
  const auto base = viewpoint_of({8, 5, 0}, site.eyes[0], {{1, 5}, 0, 0}, site);
  ASSERT_TRUE(base);
  EXPECT_TRUE(site.sees(site.eyes[0], *base, {8, 5, 0}));
}

TEST(Viewpoint, SeesObjectsAtEveryHeightThatTheCameraReaches) {
  const Site site{solid_room()};
  const Eye& eye = site.eyes[0];
  for (const double height : {0.3, 0.9, 1.2, 1.8, 2.5}) {
    const Eigen::Vector3d point(7, 7, height);
    const auto base = viewpoint_of(point, eye, {{2, 2}, 0, 0}, site);
    ASSERT_TRUE(base) << height;
    EXPECT_TRUE(site.sees(eye, *base, point)) << height;
  }
  // From 4.5 m the lower edge of the view is 1.65 m below the camera: what lies farther down than
  // the floor is not seen from anywhere.
  EXPECT_FALSE(viewpoint_of({7, 7, -2}, eye, {{2, 2}, 0, 0}, site));
}

TEST(Viewpoint, ASensorThatDoesNotMoveTheBaseLooksFromWhereItIs) {
  RoomOptions options;
  options.verification = R"("moves_base": false)";
  const Site site{room(options)};
  const BasePose here{{5, 5}, 0, 0};
  EXPECT_FALSE(viewpoint_of({8, 5, 0}, site.eyes[0], here, site));
  const auto base = viewpoint_of({6, 5, 0}, site.eyes[0], here, site);
  ASSERT_TRUE(base);
  EXPECT_EQ(base->position, here.position);
  EXPECT_EQ(base->yaw, here.yaw);
}

TEST(Viewpoint, SharedOnesSeeSeveral) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  const std::vector<Subject> subjects{cup("a", 7, 7, 1, knowledge),
                                      cup("b", 7.5, 7.8, 1, knowledge),
                                      cup("c", 8, 6.5, 1, knowledge), cup("d", 1, 9, 1, knowledge)};
  const auto all = viewpoints(subjects, {{1, 1}, 0, 0}, 4, 10, site);
  ASSERT_EQ(all.size(), 5u);  // one each, and one that sees the first three
  EXPECT_TRUE(all[4].shared);
  int seen = 0;
  for (const Subject& subject : subjects)
    seen += site.sees(site.eyes[0], all[4].base, subject.mean());
  EXPECT_EQ(seen, 3);
}

TEST(Viewpoint, OfTooManyTargetsTheVaguestAreKept) {
  const Knowledge knowledge = room();
  const std::vector<Subject> subjects{cup("a", 7, 7, 0.1, knowledge), cup("b", 2, 2, 3, knowledge),
                                      cup("c", 8, 1, 1, knowledge)};
  const auto all = viewpoints(subjects, {{1, 1}, 0, 0}, 0, 2, Site(knowledge));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].subject, 1);
  EXPECT_EQ(all[1].subject, 2);
}

TEST(Viewpoint, WhatIsNoTargetHasNone) {
  const Knowledge knowledge = room();
  const Site site(knowledge);
  std::vector<Subject> subjects{cup("a", 7, 7, 1, knowledge), cup("b", 2, 2, 1, knowledge)};
  subjects[0].target = false;
  const auto all = viewpoints(subjects, {{1, 1}, 0, 0}, 0, 10, site);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].subject, 1);
}

}  // namespace
}  // namespace anchord
