#include "anchoring/leaf.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "anchoring/leaf_event.h"
#include "anchoring/reading.h"
#include "anchoring/visibility.h"
#include "tests/anchoring/dice.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Some hundred multiplications and normalisations.
constexpr double kRounding = 1e-11;

/// A cup moves, hides in the kitchen or on the table; a box stays, or is somewhere in the hall.
constexpr const char* kTwoKinds = R"({"classes": {
    "cup": {"models": [{"kind": "constant_velocity", "acceleration_psd": 0.01,
                        "initial_velocity_variance": 0.02},
                       {"kind": "somewhere", "place": "kitchen", "rate": 0.05},
                       {"kind": "somewhere", "place": "table", "rate": 0.02}],
            "changes": {"color": {"redraw": 0.05}}},
    "box": {"models": [{"kind": "constant_position", "position_psd": 0.001},
                       {"kind": "somewhere", "place": "kitchen", "rate": 0.03}],
            "detection_probability": 0.6,
            "changes": {"size": {"drift": 0.0001},
                        "color": {"transitions": [{"from": "red", "to": "green", "rate": 0.05},
                                                  {"from": "green", "to": "blue", "rate": 0.02},
                                                  {"from": "blue", "to": "red", "rate": 0.3}]}}}}})";

double weights(const Leaf& leaf) {
  double sum = 0;
  for (const auto& model : leaf.models) sum += model.weight;
  return sum;
}

void expect_alike(const Leaf& a, const Leaf& b, const Background& background) {
  EXPECT_NEAR(a.existence, b.existence, kRounding);
  ASSERT_EQ(a.model_class, b.model_class);
  for (std::size_t c = 0; c < a.classes.size(); ++c)
    EXPECT_NEAR(a.classes[c], b.classes[c], kRounding);
  for (std::size_t m = 0; m < a.models.size(); ++m)
    EXPECT_NEAR(a.models[m].weight, b.models[m].weight, kRounding);
  ASSERT_EQ(a.attributes.size(), b.attributes.size());
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    EXPECT_NEAR(a.attributes[i].mean, b.attributes[i].mean, kRounding);
    EXPECT_NEAR(a.attributes[i].variance, b.attributes[i].variance, kRounding);
    for (std::size_t s = 0; s < a.attributes[i].symbols.size(); ++s)
      EXPECT_NEAR(a.attributes[i].symbols[s], b.attributes[i].symbols[s], kRounding);
  }
  const Gaussian x = moments(a), y = moments(b);
  EXPECT_TRUE(x.mean.isApprox(y.mean, kRounding));
  EXPECT_TRUE(x.covariance.isApprox(y.covariance, 1e-9)) << "differences of squares";
  EXPECT_EQ(a.utime, b.utime);
  EXPECT_LT(difference(a, b, background), 1e-9);
}

class Leaves : public testing::Test {
 protected:
  explicit Leaves(const char* configuration = kTwoKinds) : world(small_world(configuration)) {}

  const Background& background() const { return *world.background(); }

  MapFrame random_frame() {
    Frame f = frame(0, {at(dice.uniform(0.5, 3), dice.uniform(0.5, 3), dice.scale(1e-4, 1))});
    auto& attributes = f.detections[0].attributes;
    const double p = dice.uniform(0.1, 0.9);
    if (dice.chance(0.5)) attributes.push_back({"class", SymbolReport{{{"cup", p}}}});
    if (dice.chance(0.5)) attributes.push_back({"color", SymbolReport{{{"red", p}}}});
    if (dice.chance(0.5))
      attributes.push_back({"size", ScalarReport{dice.uniform(0, 0.3), dice.scale(1e-4, 1e-2)}});
    f.view = View{};
    f.view->type = View::Type::kPolygon;
    const double x = dice.uniform(0, 3), y = dice.uniform(0, 3);
    f.view->points = {{x, y}, {x + 2, y}, {x + 2, y + 2}, {x, y + 2}};
    auto placed = place_in_map(f, background());
    EXPECT_TRUE(placed.ok());
    return std::move(*placed);
  }

  Leaf random_first() {
    const MapFrame f = random_frame();
    const std::vector<double> terms{dice.uniform(0.1, 1), dice.uniform(0.1, 1)};
    return first_leaf(f.detections[0], terms, dice.uniform(0.1, 1), at_second(0), background());
  }

  /// Time, then a detection or a miss.
  void live(Leaf& leaf) {
    if (dice.chance(0.8))
      predict(leaf, leaf.utime + from_seconds(dice.scale(0.01, 30)), background());
    const MapFrame f = random_frame();
    const Visibility visibility(f, background());
    const LeafVisibility shown = visibility.of(leaf, *f.sensor, {}, 0);
    if (dice.chance(0.5)) {
      give(leaf, f.detections[0], shown, *f.sensor, background());
      visibility.find(leaf, {}, 0);
    } else {
      give_nothing(leaf, shown, visibility, *f.sensor, background());
    }
  }

  Leaf random_leaf() {
    Leaf leaf = random_first();
    for (int i = dice.integer(0, 6); i > 0; --i) live(leaf);
    return leaf;
  }

  /// Two predictions of a leaf and a long one.
  void expect_steps_to_be_one(const Leaf& leaf) {
    Leaf once = leaf, twice = leaf;
    const Utime end = leaf.utime + from_seconds(dice.scale(0.01, 100));
    predict(once, end, background());
    predict(twice, end - (end - leaf.utime) / 3, background());
    predict(twice, end, background());
    expect_alike(once, twice, background());
  }

  std::mt19937_64 random{9};
  Dice dice{random};
  World world;
};

TEST_F(Leaves, TwoPredictionsEqualOneLongOne) {
  for (int n = 0; n < 200; ++n) {
    expect_steps_to_be_one(random_leaf());
  }
}

/// Both hide while they go on as before; the box also stops hiding.
constexpr const char* kHiding = R"({"classes": {
    "cup": {"models": [{"kind": "constant_velocity", "acceleration_psd": 0.01,
                        "initial_velocity_variance": 0.02},
                       {"kind": "constant_velocity", "acceleration_psd": 0.01,
                        "initial_velocity_variance": 0.02, "detectable": false},
                       {"kind": "somewhere", "place": "table", "rate": 0.02}],
            "transitions": [{"from": 0, "to": 1, "rate": 0.5}]},
    "box": {"models": [{"kind": "constant_position", "position_psd": 0.001},
                       {"kind": "constant_position", "position_psd": 0.001,
                        "detectable": false}],
            "transitions": [{"from": 0, "to": 1, "rate": 0.1},
                            {"from": 1, "to": 0, "rate": 2}]}}})";

struct HidingLeaves : Leaves {
  HidingLeaves() : Leaves(kHiding) {}
};

TEST_F(HidingLeaves, TwoPredictionsEqualOneLongOneWhereTheMotionIsTheSame) {
  for (int n = 0; n < 200; ++n) {
    const MapFrame f = random_frame();
    Leaf leaf = first_leaf(f.detections[0], std::array{dice.uniform(0.1, 1), dice.uniform(0.1, 1)},
                           dice.uniform(0.1, 1), at_second(0), background());
    for (int i = dice.integer(0, 6); i > 0; --i) live(leaf);
    expect_steps_to_be_one(leaf);
  }
}

TEST_F(HidingLeaves, OnlyUnlikeMotionsMustBeSteppedThrough) {
  EXPECT_FALSE(background().dynamics[0].exchanges);
  EXPECT_FALSE(background().dynamics[1].exchanges);
  auto shaken = nlohmann::json::parse(kHiding);
  shaken["classes"]["box"]["models"][1]["position_psd"] = 0.002;
  const World other(small_world(shaken.dump()));
  EXPECT_FALSE(other.background()->dynamics[0].exchanges);
  EXPECT_TRUE(other.background()->dynamics[1].exchanges);
}

/// A look at where it was says nothing of where it is said to be.
TEST_F(Leaves, WhatIsPutElsewhereForgetsTheLooksAtIt) {
  const SeenPart half{0.5, 1, 0.01};
  Leaf leaf = random_first();
  const int tracked = background().dynamics[leaf.model_class].first_detectable;
  leaf.models[tracked].seen.find(half);
  ASSERT_EQ(leaf.models[tracked].seen.share(half), 1);
  put_somewhere(leaf, background().knowledge.find_place("hall"), background());
  MapEvent missing;  // in vain, at nothing
  LookedAt nothing(missing);
  lose(leaf, background().knowledge.default_sensor, nothing, background());
  ASSERT_GT(leaf.models[tracked].weight, 0);
  EXPECT_EQ(leaf.models[tracked].seen.share(half), 0.5);
}

TEST_F(Leaves, WhatSumsToOneStaysSo) {
  for (int sequence = 0; sequence < 10; ++sequence) {
    Leaf leaf = random_first();
    for (int step = 0; step < 200; ++step) {
      live(leaf);
      ASSERT_GE(leaf.existence, 0);
      ASSERT_LE(leaf.existence, 1);
      ASSERT_NEAR(weights(leaf), 1, kRounding);
      ASSERT_NEAR(std::accumulate(leaf.classes.begin(), leaf.classes.end(), 0.0), 1, kRounding);
      ASSERT_EQ(leaf.model_class, leaf.top_class());
      ASSERT_EQ(leaf.models.size(), background().object_class(leaf.model_class).models.size());
      for (const auto& belief : leaf.attributes) {
        if (belief.symbols.empty()) {
          ASSERT_GT(belief.variance, 0);
          continue;
        }
        ASSERT_NEAR(std::accumulate(belief.symbols.begin(), belief.symbols.end(), 0.0), 1,
                    kRounding);
      }
      ASSERT_TRUE(moments(leaf).covariance.allFinite());
    }
  }
}

TEST_F(Leaves, DifferenceIsZeroOfEqualsSymmetricAndAtMostOne) {
  for (int n = 0; n < 100; ++n) {
    const Leaf a = random_leaf(), b = random_leaf();
    EXPECT_EQ(difference(a, a, background()), 0);
    EXPECT_EQ(difference(a, b, background()), difference(b, a, background()));
    EXPECT_GE(difference(a, b, background()), 0);
    EXPECT_LE(difference(a, b, background()), 1);
  }
}

TEST_F(Leaves, MergeOfEqualsIsTheLeaf) {
  for (int n = 0; n < 100; ++n) {
    const Leaf leaf = random_leaf();
    expect_alike(merge(dice.scale(1e-3, 1), leaf, dice.scale(1e-3, 1), leaf, background()), leaf,
                 background());
  }
}

TEST_F(Leaves, MergeKeepsExistenceClassAndMoments) {
  int merged = 0;
  for (int n = 0; n < 300; ++n) {
    Leaf a = random_leaf(), b = random_leaf();
    if (a.model_class != b.model_class) continue;
    a.utime = b.utime = std::max(a.utime, b.utime);
    const double u = dice.uniform(0.05, 0.95);
    const Leaf m = merge(u, a, 1 - u, b, background());
    if (m.model_class != a.model_class) continue;  // densities went to other models
    ++merged;
    EXPECT_NEAR(m.existence, u * a.existence + (1 - u) * b.existence, kRounding);
    const double w = u * a.existence / m.existence, v = 1 - w;
    EXPECT_NEAR(m.classes[0], w * a.classes[0] + v * b.classes[0], kRounding);
    EXPECT_NEAR(weights(m), 1, kRounding);
    const Gaussian x = moments(a), y = moments(b), z = moments(m);
    const Eigen::Vector3d mean = w * x.mean + v * y.mean;
    EXPECT_TRUE(z.mean.isApprox(mean, 1e-9));
    const Eigen::Matrix3d second = w * (x.covariance + x.mean * x.mean.transpose()) +
                                   v * (y.covariance + y.mean * y.mean.transpose());
    EXPECT_TRUE((z.covariance + mean * mean.transpose()).isApprox(second, 1e-9));
  }
  EXPECT_GT(merged, 50);
}

TEST_F(Leaves, FollowClassGivesDensitiesToTheModelsOfTheirKindAndPlace) {
  // A cup that has been gone for a while: weight in all three models.
  Frame f = frame(0, {at(1.3, 1.6, 0.01)});
  const MapDetection z = place_in_map(f, background())->detections[0];
  Leaf leaf = first_leaf(z, std::array{0.9, 0.1}, 0.8, at_second(0), background());
  predict(leaf, at_second(10), background());
  const Leaf cup = leaf;
  leaf.classes = {0.2, 0.8};
  follow_class(leaf, background());
  ASSERT_EQ(leaf.model_class, 1);
  ASSERT_EQ(leaf.models.size(), 2u);
  // There is no constant_velocity: the moments, without a velocity, go to the first tracked model.
  const auto& from = std::get<Kinematic>(cup.models[0].density);
  const auto& to = std::get<Kinematic>(leaf.models[0].density);
  EXPECT_EQ(leaf.models[0].weight, cup.models[0].weight);
  EXPECT_EQ(to.position, from.position);
  EXPECT_EQ(to.pp, from.pp);
  EXPECT_TRUE(to.vv.isZero(0) && to.pv.isZero(0) && to.velocity.isZero(0));
  // The kitchen's somewhere takes its own and that of the table, which boxes do not have.
  EXPECT_NEAR(leaf.models[1].weight, cup.models[1].weight + cup.models[2].weight, kRounding);
  EXPECT_EQ(std::get<Somewhere>(leaf.models[1].density).footprint(),
            std::get<Somewhere>(cup.models[1].density).footprint());

  leaf.classes = {0.7, 0.3};
  follow_class(leaf, background());
  ASSERT_EQ(leaf.models.size(), 3u);
  const auto& back = std::get<Kinematic>(leaf.models[0].density);
  EXPECT_EQ(back.pp, from.pp);
  EXPECT_EQ(back.vv(0, 0), 0.02) << "initial_velocity_variance";
  EXPECT_EQ(leaf.models[2].weight, 0) << "nothing comes back to the table";
  EXPECT_NEAR(weights(leaf), 1, kRounding);
}

struct LeavesWithoutSomewhere : Leaves {
  LeavesWithoutSomewhere()
      : Leaves(R"({"classes": {
          "cup": {"models": [{"kind": "constant_position", "position_psd": 0.01},
                             {"kind": "somewhere", "place": "table", "rate": 0.1}]},
          "box": {"models": [{"kind": "constant_position", "position_psd": 0.01}]}}})") {}
};

TEST_F(LeavesWithoutSomewhere, FollowClassGivesSomewhereToTheFirstTrackedModelByMoments) {
  Frame f = frame(0, {at(3, 3, 0.01)});
  const MapDetection z = place_in_map(f, background())->detections[0];
  Leaf leaf = first_leaf(z, std::array{0.9, 0.1}, 0.8, at_second(0), background());
  predict(leaf, at_second(10), background());
  const Gaussian before = moments(leaf);
  leaf.classes = {0.2, 0.8};
  follow_class(leaf, background());
  ASSERT_EQ(leaf.models.size(), 1u);
  EXPECT_NEAR(leaf.models[0].weight, 1, kRounding);
  EXPECT_TRUE(moments(leaf).mean.isApprox(before.mean, kRounding));
  EXPECT_TRUE(moments(leaf).covariance.isApprox(before.covariance, kRounding));
}

TEST_F(Leaves, FollowClassWithTheSameClassChangesNothing) {
  const Leaf leaf = random_leaf();
  Leaf same = leaf;
  follow_class(same, background());
  EXPECT_EQ(difference(leaf, same, background()), 0);
}

}  // namespace
}  // namespace anchord
