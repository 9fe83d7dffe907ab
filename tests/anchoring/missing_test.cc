// Looked for and not found: against closed forms in the 6 x 4 m apartment, p_D 0.9.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

constexpr double kDetected = 0.9;          // small_world()'s p_D
constexpr double kWorld = 24, kTable = 1;  // areas, m^2
constexpr double kExactly = 1e-12;         // rounding

const RegionOfInterest kTableTop = box_of_interest(1, 1, 2, 2);

/// A class that may be somewhere in the kitchen only, 12 m^2.
constexpr const char* kInKitchen = R"({"classes": {"default": {"models": [
    {"kind": "constant_position", "position_psd": 0},
    {"kind": "somewhere", "place": "kitchen", "rate": 0}]}}})";

/// One object in the middle of the table.
World world_with_cup(const Knowledge& knowledge = small_world()) {
  World world(knowledge);
  apply(world, {frame(1, {at(1.5, 1.5)})});
  return world;
}

double in(const World& world, const std::string& place) {
  return find(world, "cup-1")
      .in_place(world.background()->knowledge.find_place(place), *world.background());
}

const Somewhere& somewhere(const World& world) {
  return std::get<Somewhere>(leaf_of(world, "cup-1").models[1].density);
}

double density(const World& world, double x, double y) {
  return somewhere(world).density(Eigen::Vector3d(x, y, 0));
}

TEST(Missing, TheShareThatWouldHaveBeenSeenIsSomewhereElse) {
  World world = world_with_cup();
  const double r = leaf_of(world, "cup-1").existence;
  apply(world, missing(1, "cup-1", kTableTop));
  const Leaf& leaf = leaf_of(world, "cup-1");
  ASSERT_EQ(leaf.models.size(), 2u);
  EXPECT_NEAR(leaf.models[0].weight, 1 - kDetected, kExactly);
  EXPECT_NEAR(leaf.models[1].weight, kDetected, kExactly);
  EXPECT_NEAR(leaf.existence, r, kExactly);
  EXPECT_EQ(density(world, 1.5, 1.5), 0);
  EXPECT_NEAR(density(world, 4, 3), 1 / (kWorld - kTable), kExactly);
  EXPECT_NEAR(in(world, "hall"), kDetected * 12 / (kWorld - kTable), kExactly);
  EXPECT_NEAR(in(world, "table"), 1 - kDetected, kExactly);
  EXPECT_NEAR(in(world, "kitchen") + in(world, "hall"), 1, kExactly);
}

TEST(Missing, AClassMayBeSomewhereInItsOwnPlaceOnly) {
  World world = world_with_cup(small_world(kInKitchen));
  apply(world, missing(1, "cup-1", kTableTop));
  EXPECT_NEAR(leaf_of(world, "cup-1").models[1].weight, kDetected, kExactly);
  EXPECT_EQ(density(world, 1.5, 1.5), 0);
  EXPECT_NEAR(density(world, 0.5, 0.5), 1.0 / (12 - kTable), kExactly);
  EXPECT_EQ(in(world, "hall"), 0);
}

TEST(Missing, AgainAndAgain) {
  World world = world_with_cup();
  const double r = leaf_of(world, "cup-1").existence;
  for (int i = 0; i < 3; ++i) apply(world, missing(1, "cup-1", kTableTop));
  EXPECT_NEAR(leaf_of(world, "cup-1").models[0].weight, 0.001, kExactly);
  EXPECT_NEAR(leaf_of(world, "cup-1").models[1].weight, 0.999, kExactly);
  EXPECT_NEAR(leaf_of(world, "cup-1").existence, r, kExactly);
  EXPECT_EQ(density(world, 1.5, 1.5), 0);
}

TEST(Missing, WhatIsSomewhereBecomesLessThere) {
  World world = world_with_cup();
  apply(world, event(Event::Kind::kMoved, 1, "cup-1"));
  apply(world, missing(1, "cup-1", kTableTop));
  EXPECT_NEAR(leaf_of(world, "cup-1").models[1].weight, 1, kExactly);
  const double left = (1 - kDetected) * kTable, all = kWorld - kTable + left;
  EXPECT_NEAR(density(world, 1.5, 1.5), (1 - kDetected) / all, kExactly);
  EXPECT_NEAR(in(world, "table"), left / all, kExactly);
}

TEST(Missing, WhatWasPutInAPlaceLeavesItByWhatWasSeenOfIt) {
  World world = world_with_cup();
  apply(world, in_place(event(Event::Kind::kPlaced, 1, "cup-1"), "table"));
  apply(world, missing(1, "cup-1", box_of_interest(1, 1, 1.5, 2)));
  const Leaf& leaf = leaf_of(world, "cup-1");
  EXPECT_NEAR(leaf.models[1].weight, kDetected / 2, kExactly);
  EXPECT_NEAR(leaf.models[0].weight, 1 - kDetected / 2, kExactly);
  EXPECT_EQ(density(world, 1.25, 1.5), 0);
  EXPECT_NEAR(density(world, 4, 3), 1 / (kWorld - 0.5), kExactly);
  // What is left at the table: 0.05 of it about x = 1.25, 0.5 about 1.75.
  EXPECT_NEAR(std::get<Kinematic>(leaf.models[0].density).position.x(),
              (0.05 * 1.25 + 0.5 * 1.75) / 0.55, kExactly);
}

TEST(Missing, WhereAllOfThePlaceWasLookedAtNothingIsLearnt) {
  for (const char* more : {"{}", kInKitchen}) {
    World world = world_with_cup(small_world(more));
    const std::string before = everything(world);
    apply(world, missing(1, "cup-1", box_of_interest(-1, -1, 7, 5)));
    EXPECT_EQ(everything(world), before);
  }
}

TEST(Missing, TheSensorsOwnDetectionProbabilityCounts) {
  World world = world_with_cup(small_world(
      R"({"sensors": {"glasses": {"detection_probability": {"cup": 0.5, "box": 0.7}}}})"));
  Event e = missing(1, "cup-1", kTableTop);
  e.sensor = "glasses";
  apply(world, e);  // no class was reported: cup or box alike
  EXPECT_NEAR(leaf_of(world, "cup-1").models[1].weight, 0.6, kExactly);
}

TEST(Missing, WhatMovesIsSharedBetweenPlacesAsTheirRatesAre) {
  World world = world_with_cup(small_world(R"({"classes": {"default": {"models": [
      {"kind": "constant_position", "position_psd": 0},
      {"kind": "somewhere", "place": "hall", "rate": 0.03},
      {"kind": "somewhere", "place": "kitchen", "rate": 0.07}]}}})"));
  apply(world, {blink(11)});  // a second of 0.1 / s, ten times
  apply(world, missing(11, "cup-1", kTableTop));
  const Leaf& leaf = leaf_of(world, "cup-1");
  const double stays = std::exp(-1.0), moves = stays * kDetected;
  EXPECT_NEAR(leaf.models[0].weight, stays * (1 - kDetected), kExactly);
  EXPECT_NEAR(leaf.models[1].weight, 0.3 * (1 - stays + moves), kExactly);
  EXPECT_NEAR(leaf.models[2].weight, 0.7 * (1 - stays + moves), kExactly);
  // What was in the kitchen became less where it was looked for; what enters is not there at all.
  const Eigen::Vector3d on_table(1.5, 1.5, 0);
  EXPECT_NEAR(std::get<Somewhere>(leaf.models[2].density).density(on_table),
              (1 - stays) / (1 - stays + moves) * (1 - kDetected) / (12 - kDetected * kTable),
              kExactly);
}

TEST(Missing, SeveralRegionsCountOnceWhereTheyMeet) {
  World world = world_with_cup();
  Event e = missing(1, "cup-1", kTableTop);
  e.regions.push_back(box_of_interest(1, 1, 3, 2));
  apply(world, e);
  EXPECT_NEAR(density(world, 4, 3), 1 / (kWorld - 2), kExactly);
  EXPECT_EQ(density(world, 2.5, 1.5), 0);
}

TEST(Missing, AHeldObjectStaysHeld) {
  World world = world_with_cup();
  apply(world, event(Event::Kind::kGrasped, 1, "cup-1"));
  const std::string before = everything(world);
  apply(world, missing(1, "cup-1", kTableTop));
  EXPECT_EQ(everything(world), before);
}

TEST(Missing, ADetectionThatNamesItFindsIt) {
  World world = world_with_cup();
  apply(world, missing(1, "cup-1", kTableTop));
  Frame found = frame(1.1, {at(4, 3)});
  found.view = View{};  // looks at nothing else
  found.detections[0].object = "cup-1";
  apply(world, {found});
  const auto object = find(world, "cup-1");
  const auto& background = *world.background();
  // Against "new or clutter", 0.019 per m^2, times the doubt: r p_D 0.9/23 to 0.019 * 0.01.
  EXPECT_GT(object.in_place(background.knowledge.find_place("hall"), background), 0.99);
  EXPECT_EQ(object.last_seen(), at_second(1.1));
}

TEST(Missing, ASomewhereThatIsOnlyImpliedIsNotThereBefore) {
  World world = world_with_cup();
  EXPECT_EQ(leaf_of(world, "cup-1").models.size(), 1u);
  apply(world, {frame(5, {at(1.5, 1.5)})});
  EXPECT_EQ(leaf_of(world, "cup-1").models.size(), 1u);
}

}  // namespace
}  // namespace anchord
