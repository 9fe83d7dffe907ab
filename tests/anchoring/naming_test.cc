#include <gtest/gtest.h>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

using Ids = std::vector<std::string>;

Detection cup(double x, double y) { return at(x, y, "class", "cup", 0.9); }
Detection box(double x, double y) { return at(x, y, "class", "box", 0.9); }

/// New objects keep coming: what nobody has seen yet does not vanish by looking.
constexpr const char* kArrivals = R"({"classes": {"default": {"arrival_rate": 0.01}}})";

/// As good as clutter: with a score of 0.01 it is new with p = 0.15.
Detection doubtful(Detection z) {
  z.score = 0.01;
  return z;
}

TEST(Naming, NewUntilItIsBelievedIn) {
  World world(small_world());
  apply(world, {frame(0, {doubtful(cup(1, 1))})});
  EXPECT_EQ(ids(world), Ids{"new-1"});
  EXPECT_LT(objects(world)[0].p, 0.5);
  apply(world, {frame(1, {cup(1, 1)})});
  EXPECT_EQ(ids(world)[0], "cup-1");
  EXPECT_GE(objects(world)[0].p, 0.5);
}

TEST(Naming, NumberedPerClassInOrderOfBirth) {
  World world(small_world());
  apply(world, {frame(0, {cup(1, 1), box(2, 1), cup(3, 1), box(4, 1)})});
  EXPECT_EQ(ids(world), (Ids{"cup-1", "box-1", "cup-2", "box-2"}));
}

TEST(Naming, WhoIsNamedLaterHasTheHigherNumber) {
  World world(small_world());
  apply(world, {frame(0, {doubtful(cup(1, 1)), cup(3, 1)})});
  EXPECT_EQ(ids(world), (Ids{"new-1", "cup-1"}));
  apply(world, {frame(1, {cup(1, 1), cup(3, 1)})});
  EXPECT_EQ(ids(world)[0], "cup-2");
  EXPECT_EQ(ids(world)[1], "cup-1");
}

TEST(Naming, ANameIsNeverGivenAgain) {
  World world(small_world(kArrivals));
  apply(world, {frame(0, {cup(1, 1)})});
  EXPECT_EQ(ids(world), Ids{"cup-1"});
  for (int second = 1; second < 20; ++second) apply(world, {frame(second, {})});
  EXPECT_EQ(ids(world), Ids{}) << "misses drove it below min_existence";
  apply(world, {frame(20, {cup(1, 1)})});
  EXPECT_EQ(ids(world), Ids{"cup-2"});
}

TEST(Naming, ANameIsKeptThoughTheClassChanges) {
  World world(small_world(kArrivals));
  apply(world, {frame(0, {at(1, 1, "class", "cup", 0.6)})});
  EXPECT_EQ(ids(world), Ids{"cup-1"});
  for (int second = 1; second < 5; ++second) apply(world, {frame(second, {box(1, 1)})});
  EXPECT_EQ(ids(world)[0], "cup-1");
  EXPECT_GT(objects(world)[0].classes(*world.background())[1], 0.9);
  apply(world, {frame(5, {box(1, 1), box(3, 3)})});
  EXPECT_EQ(ids(world).back(), "box-1") << "the name box-1 was still free";
}

TEST(Naming, ANameIsKeptThoughTheProbabilityFalls) {
  World world(small_world());
  apply(world, {frame(0, {cup(1, 1)}), frame(1, {}), frame(2, {})});
  ASSERT_EQ(ids(world), Ids{"cup-1"});
  EXPECT_LT(objects(world)[0].p, 0.5);
}

TEST(Naming, WithoutClassesItIsAnObject) {
  World world(knowledge_from(R"({"world": {"dimensions": 2, "bounds": {"min": [0, 0],
                                                                       "max": [4, 4]}}})"));
  apply(world, {frame(0, {at(1, 1)}), frame(0.1, {at(1, 1)})});
  EXPECT_EQ(ids(world)[0], "object-1");
}

}  // namespace
}  // namespace anchord
