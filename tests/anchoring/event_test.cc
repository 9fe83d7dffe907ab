// What is done to objects: grasped, carried, placed, moved, removed.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

using Kind = Event::Kind;

constexpr double kExactly = 1e-12;  // rounding
constexpr double kReach = 0.25;     // variance of what a robot holds about the robot, m^2

/// A cup on the table and one in the hall.
World two_cups(const Knowledge& knowledge = small_world()) {
  World world(knowledge);
  apply(world, {frame(1, {at(1.5, 1.5), at(5, 3)})});
  return world;
}

double in(const World& world, const std::string& object, const std::string& place) {
  return find(world, object)
      .in_place(world.background()->knowledge.find_place(place), *world.background());
}

Eigen::Vector3d mean(const World& world, const std::string& object) {
  return find(world, object).moments(*world.background()).mean;
}

Event grasped(double seconds, const std::string& object, const std::string& robot = "") {
  Event e = event(Kind::kGrasped, seconds, object);
  e.robot = robot;
  return e;
}

TEST(Events, WhatIsGraspedExistsAndMovesWithTheRobot) {
  World world = two_cups();
  const double other = find(world, "cup-2").p;
  apply(world, grasped(1, "cup-1", "amigo"));
  EXPECT_EQ(find(world, "cup-1").p, 1);
  EXPECT_EQ(find(world, "cup-1").anchor->holder, "amigo");
  EXPECT_NEAR(mean(world, "cup-1").x(), 1.5, kExactly) << "where it was, until the robot moves";
  apply(world, carried(1.2, 4, 1, "amigo"));
  EXPECT_NEAR((mean(world, "cup-1") - Eigen::Vector3d(4, 1, 0)).norm(), 0, kExactly);
  EXPECT_NEAR(find(world, "cup-1").moments(*world.background()).covariance(0, 0), kReach, kExactly);
  EXPECT_NEAR((mean(world, "cup-2") - Eigen::Vector3d(5, 3, 0)).norm(), 0, kExactly);
  EXPECT_EQ(find(world, "cup-2").p, other);
  EXPECT_FALSE(find(world, "cup-2").anchor->holder);
}

TEST(Events, APlaceSaysNothingOfWhatIsGrasped) {
  World world = two_cups(), other = two_cups();
  apply(world, in_place(grasped(1, "cup-1"), "hall"));
  apply(other, grasped(1, "cup-1"));
  EXPECT_EQ(everything(world), everything(other));
}

TEST(Events, ARobotThatCarriesTellsOfItselfNotOfTheObject) {
  World world = two_cups();
  apply(world, grasped(1, "cup-1"));
  Event e = carried(1, 4, 1);
  e.covariance = {0.01, 0, 0, 0, 0.04, 0, 0, 0, 1};
  apply(world, e);
  const Gaussian at = find(world, "cup-1").moments(*world.background());
  EXPECT_NEAR(at.covariance(0, 0), 0.01 + kReach, kExactly);
  EXPECT_NEAR(at.covariance(1, 1), 0.04 + kReach, kExactly);
}

TEST(Events, ARobotCarriesOnlyWhatItHolds) {
  World world = two_cups();
  apply(world, grasped(1, "cup-1", "amigo"));
  apply(world, grasped(1, "cup-2", "sergio"));
  apply(world, carried(1, 0.5, 0.5, "sergio"));
  EXPECT_NEAR(mean(world, "cup-1").x(), 1.5, kExactly);
  EXPECT_NEAR(mean(world, "cup-2").x(), 0.5, kExactly);
  apply(world, grasped(1, "cup-1", "sergio"));
  apply(world, carried(1, 4, 1, "amigo"));
  EXPECT_NEAR(mean(world, "cup-1").x(), 1.5, kExactly) << "handed over";
}

TEST(Events, MissesAndTimeSayNothingWhileHeld) {
  const Knowledge knowledge = small_world(R"({"classes": {"default": {"departure_rate": 0.1,
      "models": [{"kind": "constant_velocity", "acceleration_psd": 0.1},
                 {"kind": "somewhere", "rate": 0.1}]}}})");
  World world = two_cups(knowledge);
  apply(world, grasped(1, "cup-1"));
  const std::string before = everything(world);
  for (double t : {1.5, 2.0, 10.0}) apply(world, {frame(t, {})});
  EXPECT_EQ(find(world, "cup-1").p, 1);
  EXPECT_EQ(leaf_of(world, "cup-1").models[0].weight, 1);
  EXPECT_NEAR(find(world, "cup-1").moments(*world.background()).covariance(0, 0), 1e-4, kExactly);
  EXPECT_LT(find(world, "cup-2").p, 0.1);
}

TEST(Events, ADetectionFindsWhatIsHeldUnderItsName) {
  World world = two_cups();
  apply(world, grasped(1, "cup-1"));
  apply(world, carried(1.1, 4, 1));
  apply(world, {frame(1.2, {at(4.3, 1.2), at(5, 3)})});
  EXPECT_EQ(ids(world).front(), "cup-1");
  EXPECT_NEAR(mean(world, "cup-1").x(), 4.3, 0.02);  // the doubt whether it is clutter
  EXPECT_NEAR(find(world, "cup-1").p, 1, kExactly);
  EXPECT_EQ(find(world, "cup-1").anchor->holder, "");
}

TEST(Events, WorldsWithoutAnObjectThatWasGraspedAreExcluded) {
  // The second detection is the first cup's (moved by 3 standard deviations), or a new one's.
  World world(small_world(kExact));
  apply(world, {frame(0, {at(1, 1)}), frame(1, {at(1.0424, 1)})});
  ASSERT_EQ(world.belief()->clusters.size(), 1u);
  ASSERT_EQ(world.belief()->clusters[0]->hypotheses.size(), 2u);
  apply(world, grasped(1, "new-2"));
  EXPECT_EQ(find(world, "cup-2").p, 1) << "and has a name by now";
  // So the first was missed: r (1 - p_D) / (1 - r p_D), r = 0.018 / 0.019.
  const double r = 0.018 / 0.019;
  EXPECT_NEAR(find(world, "cup-1").p, r * 0.1 / (1 - 0.9 * r), kExactly);
  for (const auto& cluster : world.belief()->clusters) EXPECT_EQ(cluster->hypotheses.size(), 1u);
}

TEST(Events, WorldsCountByHowLikelyTheObjectIsThere) {
  // Two worlds: A has it with r 1 (given both detections), B with r after a miss.
  World world(small_world(kExact));
  apply(world, {frame(0, {at(1, 1)}), frame(1, {at(1.0424, 1)})});
  const Cluster& cluster = *world.belief()->clusters[0];
  double exist = 0, second = 0;
  for (const Hypothesis& h : cluster.hypotheses) {
    const double p = std::exp(h.log_weight) * cluster.anchors[0].leaves[h.leaf[0]]->existence;
    exist += p;
    if (h.leaf[1] != Hypothesis::kNoLeaf) second += p * cluster.anchors[1].leaves[0]->existence;
  }
  apply(world, grasped(1, "cup-1"));
  EXPECT_EQ(find(world, "cup-1").p, 1);
  EXPECT_NEAR(objects(world)[1].p, second / exist, kExactly);
}

TEST(Events, PlacedInAPlace) {
  World world = two_cups();
  apply(world, grasped(1, "cup-1"));
  apply(world, in_place(event(Kind::kPlaced, 1, "cup-1"), "hall"));
  EXPECT_NEAR(in(world, "cup-1", "hall"), 1, kExactly);
  EXPECT_NEAR(in(world, "cup-1", "kitchen"), 0, kExactly);
  EXPECT_FALSE(find(world, "cup-1").anchor->holder);
  EXPECT_FALSE(leaf_of(world, "cup-1").held);
  // What a best world shows of it is the middle of the hall, not where it was.
  EXPECT_NEAR(position_of(leaf_of(world, "cup-1")).position.x(), 4.5, 1e-9);
  EXPECT_NEAR(position_of(leaf_of(world, "cup-1")).pp(0, 0), 9.0 / 12, 1e-9);
  // Found there by the next detection.
  apply(world, {frame(1.1, {at(3.3, 0.5), at(5, 3)})});
  EXPECT_NEAR(mean(world, "cup-1").x(), 3.3, 0.4);
  EXPECT_EQ(find(world, "cup-1").last_seen(), at_second(1.1));
}

TEST(Events, APlaceThatWasToldOutlivesADoubtAboutTheClass) {
  // Boxes are hardly ever detected: b is 0.9 * 0.85 to 0.1 * 0.15, and after two misses by
  // 0.1^2 to 0.9^2 rather a box.
  World world(small_world(R"({"classes": {"box": {"detection_probability": 0.1}}})"));
  apply(world, {frame(1, {at(1.5, 1.5, "class", "cup", 0.85)})});
  apply(world, in_place(event(Kind::kPlaced, 1, "cup-1"), "table"));
  apply(world, {frame(1.5, {}), frame(1.6, {})});
  ASSERT_EQ(leaf_of(world, "cup-1").model_class, 1);
  EXPECT_NEAR(in(world, "cup-1", "table"), 1, kExactly);
}

TEST(Events, PlacedAtAPosition) {
  World world = two_cups();
  apply(world, grasped(1, "cup-1"));
  Event e = at_position(event(Kind::kPlaced, 1, "cup-1"), 4, 2);
  e.covariance = {0.02, 0.001, 0, 0.001, 0.03, 0, 0, 0, 1};
  apply(world, e);
  const Gaussian there = find(world, "cup-1").moments(*world.background());
  EXPECT_NEAR((there.mean - Eigen::Vector3d(4, 2, 0)).norm(), 0, kExactly);
  EXPECT_NEAR(there.covariance(0, 0), 0.02, kExactly);
  EXPECT_NEAR(there.covariance(0, 1), 0.001, kExactly);
  EXPECT_NEAR(in(world, "cup-1", "hall"), 1, 1e-9);
}

TEST(Events, PlacedWhereTheRobotIsRestsThere) {
  const Knowledge knowledge = small_world(R"({"classes": {"default": {"models": [
      {"kind": "constant_velocity", "acceleration_psd": 0.1, "initial_velocity_variance": 0.3}]}}})");
  World world(knowledge);
  for (int i = 0; i < 5; ++i) apply(world, {frame(0.2 * i, {at(1 + 0.2 * i, 1)})});
  const std::string name = ids(world)[0];
  ASSERT_GT(find(world, name).shown().models[0].weight, 0.9);
  ASSERT_GT(position_of(find(world, name).shown()).velocity.x(), 0.5);
  apply(world, grasped(0.8, name));
  apply(world, event(Kind::kPlaced, 0.8, name));
  const Kinematic placed = position_of(find(world, name).shown());
  EXPECT_EQ(placed.velocity.norm(), 0);
  EXPECT_NEAR(placed.vv(0, 0), 0.3, kExactly);
  EXPECT_NEAR(placed.position.x(), 1.8, 0.05);  // the filter's lag
}

TEST(Events, MovedWithNoWordOfWhere) {
  World world = two_cups();
  apply(world, event(Kind::kMoved, 1, "cup-1"));
  EXPECT_NEAR(in(world, "cup-1", "hall"), 0.5, kExactly);
  EXPECT_NEAR(in(world, "cup-1", "table"), 1.0 / 24, kExactly);
  World home = two_cups(small_world(R"({"classes": {"default": {"models": [
      {"kind": "constant_position", "position_psd": 0},
      {"kind": "somewhere", "place": "kitchen", "rate": 0}]}}})"));
  apply(home, event(Kind::kMoved, 1, "cup-1"));
  EXPECT_NEAR(in(home, "cup-1", "table"), 1.0 / 12, kExactly);
}

TEST(Events, MovedToAPlaceOrAPosition) {
  World world = two_cups();
  apply(world, in_place(event(Kind::kMoved, 1, "cup-1"), "hall"));
  EXPECT_NEAR(in(world, "cup-1", "hall"), 1, kExactly);
  apply(world, at_position(event(Kind::kMoved, 1, "cup-1"), 0.5, 0.5));
  EXPECT_NEAR((mean(world, "cup-1") - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 0, kExactly);
  EXPECT_EQ(find(world, "cup-1").p, 1);
}

TEST(Events, WhatIsRemovedIsGoneAndItsNameIsNotUsedAgain) {
  World world = two_cups();
  const double other = find(world, "cup-2").p;
  apply(world, event(Kind::kRemoved, 1, "cup-1"));
  EXPECT_EQ(ids(world), std::vector<std::string>{"cup-2"});
  EXPECT_EQ(find(world, "cup-2").p, other);
  apply(world, {frame(2, {at(1.5, 1.5), at(5, 3)})});
  EXPECT_FALSE(find_anchor(*world.belief(), "cup-1"));
  EXPECT_EQ(world.apply(grasped(2, "cup-1")).error().code, ErrorCode::kUnknown);
}

TEST(Events, TheBeliefsTimeIsThatOfTheFrames) {
  World world = two_cups();
  for (double ahead : {0.3, 1000.0}) {
    apply(world, at_position(event(Kind::kMoved, 1 + ahead, "cup-1"), 2, 2));
    EXPECT_EQ(world.belief()->utime, at_second(1));
    EXPECT_EQ(leaf_of(world, "cup-1").utime, at_second(1));
  }
}

TEST(Events, CarriedBeforeAnythingIsBelievedChangesNothing) {
  World world(small_world()), other(small_world());
  apply(world, carried(0, 1, 1));
  EXPECT_TRUE(objects(world).empty());
  for (World* w : {&world, &other}) apply(*w, {frame(0, {at(1, 1)}), frame(0.1, {at(1, 1)})});
  EXPECT_EQ(everything(world), everything(other));
}

}  // namespace
}  // namespace anchord
