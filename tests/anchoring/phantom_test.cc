#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "anchoring/score_trace.h"
#include "api/world_line.h"
#include "tests/anchoring/small_events.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr double kRounding = 1e-12;

/// A cup as likely as a phantom, before the score; no boxes, nearly no clutter.
Knowledge haunted() {
  auto more = nlohmann::json::parse(kExact);
  more["attributes"]["class"]["symbols"] = {"cup", "ghost"};
  more["classes"]["ghost"]["phantom"] = true;
  more["sensors"]["default"]["clutter_density"] = 1e-12;
  return small_world(more.dump());
}

Detection scored(double x, double score) {
  Detection z = at(x, 1);
  z.score = score;
  return z;
}

TEST(Phantom, IsBelievedInByNobodyWhoAsks) {
  World world(haunted());
  apply(world, {frame(0, {scored(1, 0.1), scored(4, 0.9)})});
  const auto found = objects(world);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].p, 0.1, 1e-9);  // of clutter there is 1e-9 of it
  EXPECT_FALSE(found[0].in_best);
  EXPECT_EQ(found[0].anchor->id(), "new-1");
  EXPECT_NEAR(found[1].p, 0.9, 1e-9);
  EXPECT_TRUE(found[1].in_best);
  EXPECT_EQ(found[1].anchor->id(), "cup-1");
  for (const auto& object : found) {
    EXPECT_NEAR(object.classes(*world.background())[0], 1, kRounding);
    EXPECT_EQ(object.classes(*world.background())[1], 0);
  }
  const auto line = world_line(*world.belief(), *world.background(), {});
  EXPECT_EQ(line["objects"].size(), 1u);
  EXPECT_NEAR(line["expected_count"].get<double>(), 1, 1e-9);
  const auto count = count_distribution(*world.belief(), at_second(0), {}, -1, *world.background());
  ASSERT_EQ(count.size(), 3u);
  EXPECT_NEAR(count[0], 0.9 * 0.1, 1e-9);
  EXPECT_NEAR(count[2], 0.1 * 0.9, 1e-9);
}

/// Reported as a cup for certain, in a world of cups, boxes and ghosts, each as likely.
double p_of_a_cup(const char* look, double score) {
  auto more = nlohmann::json::parse(kExact);
  more["attributes"]["class"]["symbols"] = {"cup", "box", "ghost"};
  more["classes"]["ghost"]["phantom"] = true;
  if (*look) more["classes"]["ghost"]["looks_like"] = look;
  more["sensors"]["default"]["clutter_density"] = 1e-12;
  more["sensors"]["default"]["real_share"] = {{"cup", 0.2}, {"default", 0.5}};
  World world(small_world(more.dump()));
  Detection z = scored(1, score);
  z.attributes.push_back({"class", SymbolReport{{{"cup", 1.0}}}});
  apply(world, {frame(0, {z})});
  return objects(world)[0].p;
}

/// A cup's report is twice as likely of a cup as of anything, and of a box 1e-6 of that.
TEST(Phantom, IsReportedAsWhatItLooksLike) {
  constexpr double kFloor = 1e-5;  // a report is certain to 1e-6
  EXPECT_NEAR(p_of_a_cup("", 0.2), 2.0 / 3, kFloor);
  EXPECT_NEAR(p_of_a_cup("cup", 0.2), 0.5, kFloor);
  EXPECT_NEAR(p_of_a_cup("box", 0.2), 1, kFloor);
}

/// Odds of 4 to 1 by the score, of a label of which one in five is right.
TEST(Phantom, ScoresAreOddsAgainstThoseOfTheLabel) {
  EXPECT_NEAR(p_of_a_cup("cup", 0.8), 16.0 / 17, 1e-5);
}

/// Odds of clutter to an object where a cup is reported for certain, of cups and boxes.
double odds_of_clutter(std::vector<double> looks) {
  auto more = nlohmann::json::parse(kExact);
  more["attributes"]["class"]["symbols"] = {"cup", "box"};
  Knowledge knowledge = small_world(more.dump());
  knowledge.default_sensor.clutter_looks = std::move(looks);
  World world(std::move(knowledge));
  apply(world, {frame(0, {at(1, 1, "class", "cup", 1)})});
  const double p = objects(world)[0].p;
  return (1 - p) / p;
}

/// Half of what looks like anything would be reported as a cup.
TEST(Phantom, ClutterIsReportedAsWhatItLooksLike) {
  constexpr double kFloor = 1e-5;  // a report is certain to 1e-6
  const double anything = odds_of_clutter({});
  EXPECT_NEAR(odds_of_clutter({1, 0}) / anything, 2, kFloor);
  EXPECT_NEAR(odds_of_clutter({0, 1}) / anything, 0, kFloor);
  EXPECT_NEAR(odds_of_clutter({0.5, 0.5}) / anything, 1, kFloor);
}

TEST(Phantom, IsNotAmongWhatNobodyHasSeen) {
  World world(haunted());
  apply(world, {blink(0)});
  EXPECT_NEAR(undetected(*world.belief(), at_second(0), {}, -1, *world.background()), 0.01 * 24,
              kRounding);
}

TEST(Phantom, IsRememberedAndGivesNoSecondProof) {
  Knowledge knowledge = haunted();
  knowledge.limits = {};  // of what is as probable as this, all is kept
  World world(knowledge);
  for (int i = 0; i < 20; ++i) apply(world, {frame(0.1 * i, {at(1, 1)})});
  ASSERT_EQ(objects(world).size(), 1u);
  EXPECT_NEAR(objects(world)[0].p, 0.5, 1e-6) << "both are found as often";
}

TEST(Phantom, WhatIsGraspedIsNone) {
  World world(haunted());
  apply(world, {frame(0, {scored(1, 0.1)})});
  Event grasped = event(Event::Kind::kGrasped, 0, "new-1");
  grasped.robot = "amigo";
  apply(world, grasped);
  ASSERT_EQ(objects(world).size(), 1u);
  EXPECT_NEAR(objects(world)[0].p, 1, kRounding);
  EXPECT_EQ(objects(world)[0].anchor->id(), "cup-1");
}

TEST(Phantom, IsReportedAsNothing) {
  World world(haunted());
  const Status refused = world.apply(frame(0, {at(1, 1, "class", "ghost", 0.5)}));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().field, "detections[0].attributes.class.ghost");
}

/// One score of a thing that lasts is as good as a hundred: 1 / share of what one says.
TEST(ScoreTrace, ScoresThatLastAreNoNews) {
  const ScoreEvidence evidence{2.0, {0.8, 1e9}};
  ScoreTrace trace;
  double sum = 0;
  for (int i = 0; i < 100'000; ++i) {
    sum += trace.log_ratio(evidence, at_second(0.1 * i));
    trace.take(evidence, at_second(0.1 * i));
    if (i == 0) {
      EXPECT_NEAR(sum, 2.0, kRounding);
    }
  }
  EXPECT_NEAR(sum, 2.0 / 0.8, 1e-3);  // what is left of 1e5 scores falls as 1 / n; so does 1e9 s
}

TEST(ScoreTrace, IndependentScoresAddUp) {
  const ScoreEvidence evidence{-1.5, {0, 1}};
  ScoreTrace trace;
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(trace.log_ratio(evidence, at_second(i)), -1.5, kRounding);
    trace.take(evidence, at_second(i));
  }
}

/// Where all of it lasts, only the change beyond what fades counts: (x2 - k x1) / (1 + k).
TEST(ScoreTrace, FollowsAnAutoregression) {
  ScoreTrace trace;
  trace.take({3.0, {1 - 1e-12, 2.0}}, at_second(0));
  const double k = std::exp(-0.5 / 2.0);
  EXPECT_NEAR(trace.log_ratio({1.0, {1 - 1e-12, 2.0}}, at_second(0.5)), (1 - 3 * k) / (1 + k),
              1e-9);
}

}  // namespace
}  // namespace anchord
