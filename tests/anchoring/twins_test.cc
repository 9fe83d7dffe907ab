#include "anchoring/twins.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr int kNone = Hypothesis::kNoLeaf;

const Background& background() {
  static const Background made(small_world());
  return made;
}

std::shared_ptr<const Leaf> leaf(double x) {
  MapFrame f = *place_in_map(frame(0, {at(x, 1)}), background());
  return std::make_shared<const Leaf>(
      first_leaf(f.detections[0], std::array{0.5, 0.5}, 1, at_second(0), background()));
}

/// Anchors with leaves at the given places, and possible worlds: probability, leaf of each anchor.
Cluster cluster(const std::vector<std::vector<double>>& places,
                const std::vector<std::pair<double, std::vector<int>>>& worlds) {
  Cluster out;
  for (std::size_t a = 0; a < places.size(); ++a) {
    out.anchors.push_back({std::make_shared<const Anchor>(Anchor{a + 1, "", "", {}}), {}});
    for (double x : places[a]) out.anchors.back().leaves.push_back(leaf(x));
  }
  for (const auto& [p, leaves] : worlds)
    out.hypotheses.push_back({std::log(p), {leaves.begin(), leaves.end()}});
  return out;
}

TEST(Twins, TheMoreProbableNameTakesTheOthersWorlds) {
  Cluster c = cluster({{2}, {2}}, {{0.6, {kNone, 0}}, {0.4, {0, kNone}}});
  join_twins(c, background());
  ASSERT_EQ(c.hypotheses.size(), 1u);
  EXPECT_NEAR(c.existence(1, background()), 1, 1e-15);
  EXPECT_EQ(c.existence(0, background()), 0);
}

TEST(Twins, TheNameThatIsShownStaysUntilTheOtherIsClearlyMoreProbable) {
  for (const double p : {0.3, 0.2}) {
    Cluster c = cluster({{2}, {2}}, {{1 - p, {kNone, 0}}, {p, {0, kNone}}});
    c.anchors[0].shown = 0;
    join_twins(c, background());
    const bool stays = p > 0.25;  // a third of the other's
    EXPECT_NEAR(c.existence(0, background()), stays ? 1 : 0, 1e-15);
    EXPECT_EQ(c.anchors[1].shown, stays ? kNone : 0);
  }
}

TEST(Twins, WorldsWithBothOfThemStay) {
  // Who left, in the last two worlds, is told by the past only; the first has both.
  Cluster c = cluster({{2}, {2, 4}}, {{0.5, {0, 1}}, {0.3, {0, kNone}}, {0.2, {kNone, 0}}});
  join_twins(c, background());
  ASSERT_EQ(c.hypotheses.size(), 2u);
  EXPECT_NEAR(std::exp(c.hypotheses[0].log_weight), 0.5, 1e-15);
  EXPECT_NEAR(c.existence(0, background()), 1, 1e-15);
  EXPECT_NEAR(c.existence(1, background()), 0.5, 1e-15);
}

TEST(Twins, NamesThatWereExchangedAreLeftAlone) {
  Cluster c = cluster({{2, 4}, {2, 4}}, {{0.5, {0, 1}}, {0.5, {1, 0}}});
  join_twins(c, background());
  EXPECT_EQ(c.hypotheses.size(), 2u);
}

TEST(Twins, ObjectsThatDifferAndThoseThatPeopleNamedAreLeftAlone) {
  const std::vector<std::pair<double, std::vector<int>>> worlds{{0.6, {kNone, 0}},
                                                                {0.4, {0, kNone}}};
  Cluster apart = cluster({{2}, {2.5}}, worlds), named = cluster({{2}, {2}}, worlds);
  named.anchors[0].anchor = std::make_shared<const Anchor>(Anchor{1, "cup-1", "Ann's cup", {}});
  for (Cluster* c : {&apart, &named}) {
    join_twins(*c, background());
    EXPECT_EQ(c->hypotheses.size(), 2u);
    EXPECT_NEAR(c->existence(0, background()), 0.4, 1e-15);
  }
}

TEST(Twins, WhoIsLeftOfTwoThatMetIsOneObject) {
  World world(small_world(R"({"classes": {"default": {"departure_rate": 0.05, "models": [
      {"kind": "constant_velocity", "acceleration_psd": 0.05,
       "initial_velocity_variance": 0.1}]}}})"));
  // Two come from left and right, stand together for a while, and one of them is there no more.
  for (int t = 0; t < 40; ++t) {
    const double gap = std::max(0.0, 1 - 0.2 * t);
    std::vector<Detection> seen{at(3 + gap, 2, 0.01)};
    if (t < 12) seen.push_back(at(3 - gap, 2, 0.01));
    apply(world, {frame(t, seen)});
  }
  const auto all = objects(world);
  int believed = 0;
  for (const auto& object : all) believed += object.p > 0.95 && object.in_best;
  EXPECT_EQ(believed, 1);
}

}  // namespace
}  // namespace anchord
