#include "anchoring/leading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr int kNone = Hypothesis::kNoLeaf;
constexpr int kHere = 0, kThere = 1;  // leaves of the anchors below

std::shared_ptr<const Leaf> at(double x) {
  Leaf leaf;
  leaf.existence = 1;
  Kinematic density;
  density.position.x() = x;
  density.pp.diagonal().setConstant(0.01);
  leaf.models.push_back({1, density});
  return std::make_shared<const Leaf>(std::move(leaf));
}

const Background& background() {
  static const Background made(small_world());
  return made;
}

struct World {
  double probability;
  std::vector<int> leaf;
};

/// Two objects, each at x = 0 or x = 5 m, and the world shown so far: the first is at 0.
Cluster two_objects(const std::vector<World>& worlds) {
  Cluster cluster;
  for (std::uint64_t birth : {1, 2})
    cluster.anchors.push_back({std::make_shared<const Anchor>(Anchor{birth, "", "", std::nullopt}),
                               {at(0), at(5), at(9)},
                               kNone});
  for (const World& w : worlds) {
    Hypothesis h{std::log(w.probability), {}};
    h.leaf.assign(w.leaf.begin(), w.leaf.end());
    cluster.hypotheses.push_back(std::move(h));
  }
  cluster.anchors[0].shown = kHere;
  cluster.anchors[1].shown = kThere;
  return cluster;
}

TEST(Leading, KeepsNamesWhileTheExchangeIsNotClearlyMoreProbable) {
  Cluster cluster = two_objects({{0.74, {kThere, kHere}}, {0.26, {kHere, kThere}}});
  choose_leading(cluster, background());
  EXPECT_EQ(cluster.leading, 1);
  EXPECT_EQ(cluster.anchors[0].shown, kHere);
  ASSERT_TRUE(cluster.best_leaf(0));
  EXPECT_EQ(cluster.best_leaf(0)->models[0].weight, 1);
}

TEST(Leading, ChangesNamesOnceTheExchangeIsThreeTimesAsProbable) {
  Cluster cluster = two_objects({{0.76, {kThere, kHere}}, {0.24, {kHere, kThere}}});
  choose_leading(cluster, background());
  EXPECT_EQ(cluster.leading, 0);
  EXPECT_EQ(cluster.anchors[0].shown, kThere);
}

TEST(Leading, AnotherStateOfTheWorldIsShownAtOnce) {
  // The first has moved on to 9 m: no matter of names.
  Cluster moved = two_objects({{0.6, {2, kThere}}, {0.4, {kHere, kThere}}});
  choose_leading(moved, background());
  EXPECT_EQ(moved.leading, 0);
  // The first was never there.
  Cluster fewer = two_objects({{0.6, {kNone, kThere}}, {0.4, {kHere, kThere}}});
  choose_leading(fewer, background());
  EXPECT_EQ(fewer.leading, 0);
}

TEST(Leading, OneObjectUnderTwoNamesKeepsTheNameItWasShownUnder) {
  // The first detection was the object's, or clutter, and the object came with the second.
  const auto twins = [](double other_name) {
    Cluster cluster = two_objects({{other_name, {kNone, kHere}}, {1 - other_name, {kHere, kNone}}});
    cluster.anchors[1].shown = kNone;
    choose_leading(cluster, background());
    return cluster.leading;
  };
  EXPECT_EQ(twins(0.6), 1);
  EXPECT_EQ(twins(0.74), 1);
  EXPECT_EQ(twins(0.76), 0) << "three times as probable";
}

TEST(Leading, AnObjectThatIsGoneIsNotItsNeighbour) {
  // The second one stays where it was shown, close to where the first was: nobody took its place.
  Cluster cluster = two_objects({{0.6, {kNone, kHere}}, {0.4, {kHere, kNone}}});
  cluster.anchors[1].shown = kHere;
  choose_leading(cluster, background());
  EXPECT_EQ(cluster.leading, 0);
}

TEST(Leading, WithoutAWorldShownBeforeTheMostProbableLeads) {
  Cluster cluster = two_objects({{0.6, {kThere, kHere}}, {0.4, {kHere, kThere}}});
  cluster.anchors[0].shown = cluster.anchors[1].shown = kNone;
  choose_leading(cluster, background());
  EXPECT_EQ(cluster.leading, 0);
}

}  // namespace
}  // namespace anchord
