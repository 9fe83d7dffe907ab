#include "maintenance/planner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

class EachPlanner : public testing::TestWithParam<const char*> {
 protected:
  Knowledge knowledge(const std::string& more, const std::string& walls = "[]") const {
    RoomOptions options;
    options.walls = walls;
    options.maintenance = std::string(R"("planner": ")") + GetParam() + "\", " + more;
    return room(options);
  }
};
INSTANTIATE_TEST_SUITE_P(Planners, EachPlanner, testing::Values("greedy", "lookahead"));

TEST_P(EachPlanner, DoesNothingWhereNothingGains) {
  const Knowledge k = knowledge(R"("threshold": 0.5)");
  // Known as well as the eye sees: a look gains little.
  EXPECT_FALSE(choose({cup("a", 5, 5, 0.001, k, 1e-6)}, robot_at(4, 5), Site(k)));
  EXPECT_FALSE(choose({}, robot_at(4, 5), Site(k)));
  EXPECT_TRUE(choose({cup("a", 5, 5, 1, k)}, robot_at(4, 5), Site(k)));
}

TEST_P(EachPlanner, TheThresholdIsOnTheGain) {
  const std::vector<Subject> far{cup("a", 9, 9, 1, knowledge(R"("threshold": 0)"))};
  const Knowledge low = knowledge(R"("threshold": 4)"), high = knowledge(R"("threshold": 40)");
  EXPECT_TRUE(choose(far, robot_at(1, 1), Site(low)));
  EXPECT_FALSE(choose(far, robot_at(1, 1), Site(high)));
}

TEST_P(EachPlanner, PrefersTheNearerOfTwoAlikeAndTheVaguerOfTwoAsFar) {
  const Knowledge k = knowledge(R"("threshold": 0.1)");
  const auto nearer =
      choose({cup("far", 9, 5, 1, k), cup("near", 2, 5, 1, k)}, robot_at(5, 5), Site(k));
  ASSERT_TRUE(nearer);
  EXPECT_EQ(nearer->object, "near");
  const auto vaguer =
      choose({cup("sure", 8, 5, 0.05, k), cup("vague", 2, 5, 2, k)}, robot_at(5, 5), Site(k));
  ASSERT_TRUE(vaguer);
  EXPECT_EQ(vaguer->object, "vague");
}

TEST_P(EachPlanner, AMirroredSceneGivesTheMirroredChoice) {
  const Knowledge k = knowledge(R"("threshold": 0.1, "omega": 1)");
  const Site site(k);
  const double places[][3] = {{2, 1, 1}, {8, 3, 0.4}, {6.5, 8.2, 2}, {1.5, 7, 0.8}, {9, 9, 1.5}};
  std::vector<Subject> scene, mirrored;
  for (const auto& [x, y, variance] : places) {
    const std::string id = "o" + std::to_string(scene.size());
    scene.push_back(cup(id, x, y, variance, k));
    mirrored.push_back(cup(id, 10 - x, y, variance, k));
  }
  const auto left = choose(scene, robot_at(4, 5), site);
  RobotPose turned = robot_at(6, 5);
  turned.pose.orientation = {0, 0, 0, 1};  // facing the other way
  const auto right = choose(mirrored, turned, site);
  ASSERT_TRUE(left && right);
  EXPECT_EQ(left->object, right->object);
  // Rounding of coordinates that were mirrored.
  EXPECT_NEAR(left->gain, right->gain, 1e-6);
  EXPECT_NEAR(left->utility, right->utility, 1e-6);
  EXPECT_NEAR(left->viewpoint.position.x(), 10 - right->viewpoint.position.x(), 1e-6);
  EXPECT_NEAR(left->viewpoint.position.y(), right->viewpoint.position.y(), 1e-6);
}

TEST_P(EachPlanner, GoesRoundWallsAndTellsHowFar) {
  const Knowledge k = knowledge(R"("threshold": 0.1)", "[[[5, 0], [5, 8]]]");
  const auto action = choose({cup("a", 7, 2, 2, k)}, robot_at(3, 2), Site(k));
  ASSERT_TRUE(action);
  EXPECT_GT(action->distance, 12);  // up to y = 8 and down again
  EXPECT_NEAR(action->cost, action->distance / k.maintenance.cost_scale, 1e-9);
}

TEST_P(EachPlanner, IsTheSameEveryTime) {
  const Knowledge k = knowledge(R"("threshold": 0.1)");
  const Site site(k);
  std::vector<Subject> scene;
  for (int i = 0; i < 20; ++i)
    scene.push_back(cup(std::to_string(i), 0.5 + i * 7 % 9, 0.5 + i * 5 % 9, 0.1 + 0.1 * i, k));
  const auto first = choose(scene, robot_at(5, 5), site);
  const auto second = choose(scene, robot_at(5, 5), site);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->object, second->object);
  EXPECT_EQ(first->utility, second->utility);
}

TEST(Greedy, TheUtilityIsThatOfTheThesis) {
  RoomOptions options;
  options.maintenance = R"("omega": 0.75, "cost_scale": 10, "threshold": 1)";
  options.verification = R"("cost": 0.2)";
  const Knowledge k = room(options);
  const auto action = choose({cup("a", 8, 5, 1, k)}, robot_at(1, 5), Site(k));
  ASSERT_TRUE(action);
  EXPECT_NEAR(action->distance, 7 - 1.2, 1e-9);
  EXPECT_NEAR(action->cost, 0.58 + 0.2, 1e-9);
  EXPECT_NEAR(action->utility, action->gain / 5 - 0.75 * action->cost, 1e-12);
  EXPECT_NEAR(action->gain,
              expected_gain({cup("a", 8, 5, 1, k)}, action->looks, action->duration, Site(k)),
              1e-12);
}

TEST(Greedy, TiesGoToTheFirst) {
  RoomOptions options;
  options.maintenance = R"("threshold": 1)";
  const Knowledge k = room(options);
  const auto action =
      choose({cup("first", 8, 5, 1, k), cup("second", 2, 5, 1, k)}, robot_at(5, 5), Site(k));
  ASSERT_TRUE(action);
  EXPECT_EQ(action->object, "first");
}

TEST(Greedy, AnObjectThatComesIntoViewOnTheWayCounts) {
  RoomOptions options;
  options.maintenance = R"("threshold": 0.1)";
  const Knowledge k = room(options);
  const Site site(k);
  const auto alone = choose({cup("end", 9, 5, 1, k)}, robot_at(1, 5), site);
  const auto with = choose({cup("end", 9, 5, 1, k), cup("between", 5, 6, 0.02, k)}, robot_at(1, 5),
                           site, {300, 0, 1, 1});
  ASSERT_TRUE(alone && with);
  EXPECT_EQ(with->object, "end");
  EXPECT_GT(with->gain, alone->gain + 0.5);
}

TEST(Lookahead, TakesWhatLiesOnTheWayFirst) {
  // A rewarding cluster at one end, a little less near: greedy crosses the room and comes back.
  RoomOptions options;
  options.maintenance = R"("planner": "lookahead", "threshold": 0.1, "horizon": 4)";
  const Knowledge k = room(options);
  const std::vector<Subject> scene{cup("a", 9, 1, 1.2, k), cup("b", 9, 5, 1.0, k),
                                   cup("c", 9, 9, 1.2, k)};
  // From the lower corner along the side: a, b, c, never c first.
  const auto action = choose(scene, robot_at(5, 1), Site(k));
  ASSERT_TRUE(action);
  EXPECT_EQ(action->object, "a");
}

TEST(ChooseFor, LooksAtWhatWasAskedEvenIfItGainsLittle) {
  const Knowledge k = room();
  const Site site(k);
  const std::vector<Subject> scene{cup("a", 5, 5, 0.001, k, 1e-6), cup("b", 8, 8, 2, k)};
  const auto action = choose_for(0, "", scene, robot_at(2, 5), site);
  ASSERT_TRUE(action);
  EXPECT_EQ(action->object, "a");
  EXPECT_EQ(action->sensor, "eye");
  EXPECT_FALSE(choose_for(0, "nose", scene, robot_at(2, 5), site));
}

}  // namespace
}  // namespace anchord
