// What people say of objects: their names, that two are one, that one is false; and take back.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

using Kind = Event::Kind;

constexpr double kExactly = 1e-12;       // rounding
constexpr double kBorn = 0.018 / 0.019;  // r after one detection: e / (kappa + e)

World two_cups(std::string_view more = "{}") {
  World world(small_world(more));
  apply(world, {frame(1, {at(1.5, 1.5), at(5, 3)})});
  return world;
}

/// Two anchors whose associations depend on each other, and a third by itself.
World entangled() {
  World world(small_world(kExact));
  apply(world,
        {frame(0, {at(1, 1, 0.01), at(1.15, 1, 0.01), at(5, 3)}), frame(1, {at(1.1, 1, 0.01)})});
  return world;
}

double sum_of_p(const World& world) {
  double sum = 0;
  for (const auto& object : objects(world)) sum += object.p;
  return sum;
}

TEST(Said, AnAliasIsAnotherName) {
  World world = two_cups();
  const std::string before = every_object(world);
  apply(world, named(1, "cup-1", "my mug"));
  EXPECT_EQ(find(world, "my mug").anchor->id(), "cup-1");
  EXPECT_EQ(find(world, "cup-1").anchor->alias, "my mug");
  apply(world, in_place(event(Kind::kMoved, 1, "my mug"), "hall"));
  EXPECT_EQ(find(world, "cup-1").p, 1);
  apply(world, named(1, "my mug", "the mug"));
  EXPECT_FALSE(find_anchor(*world.belief(), "my mug"));
  apply(world, named(1, "the mug", ""));
  EXPECT_FALSE(find_anchor(*world.belief(), "the mug"));
  EXPECT_TRUE(find_anchor(*world.belief(), "cup-1"));
}

TEST(Said, ADetectionMayNameItsObjectByAlias) {
  World by_id = two_cups(), by_alias = two_cups();
  for (World* world : {&by_id, &by_alias}) {
    apply(*world, named(1, "cup-1", "my mug"));
    Frame f = frame(1.1, {at(4, 3)});
    f.detections[0].object = world == &by_id ? "cup-1" : "my mug";
    apply(*world, missing(1, "cup-1", box_of_interest(1, 1, 2, 2)));
    apply(*world, {f});
  }
  EXPECT_EQ(everything(by_id), everything(by_alias));
  EXPECT_EQ(find(by_alias, "my mug").last_seen(), at_second(1.1));
}

TEST(Said, ANameGivenTwiceIsRefused) {
  World world = two_cups();
  apply(world, named(1, "cup-1", "my mug"));
  for (const char* taken : {"my mug"}) {
    const auto refused = world.apply(named(1, "cup-2", taken));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
    EXPECT_EQ(refused.error().field, "name");
  }
  apply(world, named(1, "cup-1", "my mug"));  // its own again
}

TEST(Said, AnAliasCannotBeANameThatObjectsAreGiven) {
  World world = two_cups();
  for (const char* name : {"cup-2", "cup-77", "box-1", "new-5"}) {
    const auto refused = world.apply(named(1, "cup-1", name));
    ASSERT_FALSE(refused.ok()) << name;
    EXPECT_EQ(refused.error().field, "name");
  }
  for (const char* name : {"cup-", "cup", "7", "mug-1", "cup-1a", "-1"})
    EXPECT_TRUE(world.apply(named(1, "cup-1", name)).ok()) << name;
}

TEST(Said, TwoThatAreOne) {
  World world = two_cups();
  apply(world, {frame(2, {at(5, 3)}, "ear")});  // the second is seen last
  const double ra = find(world, "cup-1").p, rb = find(world, "cup-2").p;
  apply(world, joined(2, "cup-1", "cup-2"));
  EXPECT_EQ(ids(world), std::vector<std::string>{"cup-1"});
  EXPECT_NEAR(find(world, "cup-1").p, 1 - (1 - ra) * (1 - rb), 1e-6);  // what limits cut off
  EXPECT_NEAR(find(world, "cup-1").moments(*world.background()).mean.x(), 5, 1e-3);
}

TEST(Said, OneThatIsJoinedHasSeenWhatBothHave) {
  World world(small_world(kExact));
  Detection a = at(1, 1, "color", "red", 0.7), b = at(4, 1, "color", "red", 0.4);
  a.attributes.push_back({"size", ScalarReport{0.1, 0.01}});
  b.attributes.push_back({"size", ScalarReport{0.2, 0.02}});
  apply(world, {frame(0, {a, b})});
  apply(world, joined(0, "cup-1", "cup-2"));
  const Leaf& leaf = leaf_of(world, "cup-1");
  EXPECT_NEAR(leaf.existence, 1 - (1 - kBorn) * (1 - kBorn), kExactly);
  // Red 0.7 and 0.4, the rest spread evenly over green and blue.
  const double red = 0.7 * 0.4, other = 0.15 * 0.3;
  EXPECT_NEAR(leaf.attribute(1)->symbols[0], red / (red + 2 * other), kExactly);
  EXPECT_NEAR(leaf.attribute(2)->mean, (0.1 / 0.01 + 0.2 / 0.02) / (1 / 0.01 + 1 / 0.02), kExactly);
  EXPECT_NEAR(leaf.attribute(2)->variance, 1 / (1 / 0.01 + 1 / 0.02), kExactly);
  EXPECT_NEAR(std::get<Kinematic>(leaf.models[0].density).position.x(), 1, kExactly) << "a tie";
}

TEST(Said, WhatARobotHoldsIsWhereTheJoinedOneIs) {
  World world = two_cups();
  apply(world, event(Kind::kGrasped, 1, "cup-2"));
  apply(world, named(1, "cup-2", "my mug"));
  apply(world, joined(1, "cup-1", "cup-2"));
  EXPECT_NEAR(find(world, "cup-1").moments(*world.background()).mean.x(), 5, kExactly);
  EXPECT_EQ(find(world, "my mug").anchor->name, "cup-1");
  apply(world, carried(1, 2, 2));
  EXPECT_NEAR(find(world, "cup-1").moments(*world.background()).mean.x(), 2, kExactly);
}

TEST(Said, TwoOfOneClusterThatAreOne) {
  World world = entangled();
  const auto at = *find_anchor(*world.belief(), "cup-1");
  const Cluster& cluster = *world.belief()->clusters[at.cluster];
  ASSERT_GT(cluster.hypotheses.size(), 1u);
  const int b = find_anchor(*world.belief(), "cup-2")->anchor;
  ASSERT_EQ(find_anchor(*world.belief(), "cup-2")->cluster, at.cluster);
  double expected = 0;
  for (const Hypothesis& h : cluster.hypotheses) {
    double neither = 1;
    for (const int a : {at.anchor, b})
      if (h.leaf[a] != Hypothesis::kNoLeaf)
        neither *= 1 - cluster.anchors[a].leaves[h.leaf[a]]->existence;
    expected += std::exp(h.log_weight) * (1 - neither);
  }
  const double third = find(world, "cup-3").p;
  apply(world, joined(1, "cup-1", "cup-2"));
  EXPECT_NEAR(find(world, "cup-1").p, expected, kExactly);
  EXPECT_NEAR(find(world, "cup-3").p, third, kExactly);
  EXPECT_FALSE(find_anchor(*world.belief(), "cup-2"));
}

TEST(Said, OneThatIsFalseLeavesTheOthersAsTheyAre) {
  World world = entangled();
  const double p = find(world, "cup-2").p, all = sum_of_p(world), gone = find(world, "cup-1").p;
  apply(world, event(Kind::kDropped, 1, "cup-1"));
  EXPECT_FALSE(find_anchor(*world.belief(), "cup-1"));
  EXPECT_NEAR(find(world, "cup-2").p, p, kExactly);
  EXPECT_NEAR(sum_of_p(world), all - gone, kExactly);
}

TEST(Said, UndoGivesBackWhatWasBelieved) {
  const std::vector<Event> said{named(1, "cup-1", "my mug"), joined(1, "cup-1", "cup-2"),
                                joined(1, "cup-2", "cup-1"), event(Kind::kDropped, 1, "cup-1")};
  for (const Event& e : said) {
    World world = two_cups();
    apply(world, named(1, "cup-1", "old name"));
    const std::string before = every_object(world);
    const auto number = apply(world, e);
    EXPECT_NE(every_object(world), before);
    apply(world, undone(1, number));
    EXPECT_EQ(every_object(world), before);
    EXPECT_EQ(world.apply(undone(1, number)).error().code, ErrorCode::kUnknown) << "once only";
  }
}

TEST(Said, UndoInsideAClusterGivesBackWhatWasBelievedOfEach) {
  for (const Event& e : {joined(1, "cup-1", "cup-2"), event(Kind::kDropped, 1, "cup-2")}) {
    World world = entangled();
    std::vector<double> before;
    for (const auto& object : objects(world)) before.push_back(object.p);
    apply(world, undone(1, apply(world, e)));
    const auto after = objects(world);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i].p, before[i], kExactly);
  }
}

TEST(Said, WhatIsUndoneIsAsItWasNotAsItWouldBe) {
  World world = two_cups();
  const auto number = apply(world, event(Kind::kDropped, 1, "cup-1"));
  apply(world, {frame(1.1, {at(1.5, 1.5), at(5, 3)})});  // seen again: another one, by now
  apply(world, undone(1.1, number));
  EXPECT_NEAR(find(world, "cup-1").p, kBorn, kExactly);
  EXPECT_EQ(find(world, "cup-1").last_seen(), at_second(1));
  EXPECT_EQ(objects(world).size(), 3u);
}

TEST(Said, LaterEventsAboutAnObjectAreUndoneFirst) {
  World world = two_cups();
  const std::string before = every_object(world);
  const auto first = apply(world, named(1, "cup-1", "my mug"));
  const auto second = apply(world, joined(1, "cup-2", "cup-1"));
  const auto third = apply(world, event(Kind::kDropped, 1, "cup-2"));
  for (const auto number : {first, second}) {
    const auto refused = world.apply(undone(1, number));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
    EXPECT_EQ(refused.error().field, "number");
  }
  for (const auto number : {third, second, first}) apply(world, undone(1, number));
  EXPECT_EQ(every_object(world), before);
}

TEST(Said, ANameOrAJoinOnTopOfAnotherIsUndoneFirst) {
  const std::vector<std::pair<Event, Event>> pairs{
      {named(1, "cup-1", "my mug"), named(1, "cup-1", "the mug")},
      {joined(1, "cup-1", "cup-2"), joined(1, "cup-1", "cup-3")},
      {named(1, "cup-2", "my mug"), joined(1, "cup-1", "cup-2")}};
  for (const auto& [one, two] : pairs) {
    World world(small_world());
    apply(world, {frame(1, {at(1.5, 1.5), at(5, 3), at(5, 1)})});
    const std::string before = every_object(world);
    const auto first = apply(world, one), second = apply(world, two);
    const auto refused = world.apply(undone(1, first));
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("event " + std::to_string(second)), std::string::npos)
        << refused.error().text();
    apply(world, undone(1, second));
    apply(world, undone(1, first));
    EXPECT_EQ(every_object(world), before);
  }
}

TEST(Said, EventsAboutOthersAreUndoneInAnyOrder) {
  World world = two_cups();
  const std::string before = every_object(world);
  const auto first = apply(world, named(1, "cup-1", "my mug"));
  const auto second = apply(world, event(Kind::kDropped, 1, "cup-2"));
  apply(world, undone(1, first));
  apply(world, undone(1, second));
  EXPECT_EQ(every_object(world), before);
}

TEST(Said, AnAliasThatIsTakenDoesNotComeBack) {
  World world = two_cups();
  apply(world, named(1, "cup-1", "my mug"));
  const auto number = apply(world, event(Kind::kDropped, 1, "cup-1"));
  apply(world, named(1, "cup-2", "my mug"));
  EXPECT_EQ(world.apply(undone(1, number)).error().code, ErrorCode::kConflict);
  apply(world, named(1, "cup-2", ""));
  apply(world, undone(1, number));
  EXPECT_EQ(find(world, "my mug").anchor->name, "cup-1");
}

TEST(Said, WhatHasLeftCannotBeParted) {
  World world = two_cups();
  const auto number = apply(world, joined(1, "cup-1", "cup-2"));
  apply(world, event(Kind::kRemoved, 1, "cup-1"));
  EXPECT_EQ(world.apply(undone(1, number)).error().code, ErrorCode::kConflict);
}

TEST(Said, NumbersCountFramesAndEventsAndRefusedOnesDoNot) {
  World world = two_cups();  // one frame
  EXPECT_EQ(apply(world, named(1, "cup-1", "a")), 2);
  EXPECT_FALSE(world.apply(named(1, "cup-3", "b")).ok());
  EXPECT_EQ(apply(world, named(1, "cup-1", "b")), 3);
  apply(world, {frame(1.1, {})});
  EXPECT_EQ(apply(world, named(1, "cup-1", "c")), 5);
}

TEST(Said, TheNewest64CanBeUndone) {
  World world = two_cups();
  std::vector<std::int64_t> numbers;
  for (int i = 0; i < 65; ++i)
    numbers.push_back(apply(world, named(1, "cup-1", "a" + std::to_string(i))));
  EXPECT_EQ(world.belief()->set_aside.size(), 64u);
  for (int i = 64; i > 0; --i) apply(world, undone(1, numbers[i]));
  EXPECT_EQ(find(world, "cup-1").anchor->alias, "a0");
  EXPECT_EQ(world.apply(undone(1, numbers[0])).error().code, ErrorCode::kUnknown);
}

TEST(Said, WhatIsDoneCannotBeUndone) {
  World world = two_cups();
  for (const Event& e : {event(Kind::kGrasped, 1, "cup-1"), event(Kind::kMoved, 1, "cup-1"),
                         event(Kind::kRemoved, 1, "cup-1")})
    EXPECT_EQ(world.apply(undone(1, apply(world, e))).error().code, ErrorCode::kUnknown);
}

}  // namespace
}  // namespace anchord
