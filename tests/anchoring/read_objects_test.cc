// What is believed of an object that goes by other names in other worlds.

#include <gtest/gtest.h>

#include <cmath>

#include "anchoring/reading.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

/// What all hypotheses say of an anchor by its own name.
double p_by_name(const World& world, std::uint64_t birth) {
  double p = 0;
  for (const auto& cluster : world.belief()->clusters)
    for (std::size_t a = 0; a < cluster->anchors.size(); ++a)
      if (cluster->anchors[a].anchor->birth == birth)
        for (const Hypothesis& h : cluster->hypotheses)
          if (h.leaf[a] != Hypothesis::kNoLeaf)
            p += std::exp(h.log_weight) * cluster->anchors[a].leaves[h.leaf[a]]->existence;
  return p;
}

/// Cups that are found in one frame of two, come and go; clutter.
Knowledge flickering() {
  return small_world(R"({
      "classes": {"default": {"departure_rate": 0.2, "detection_probability": 0.5,
                              "undetected_intensity": 0.01, "arrival_rate": 0.002}},
      "sensors": {"eye": {"clutter_density": 0.002}},
      "hypotheses": {"max": 100, "scan_depth": 20}})");
}

/// A cup that was lost sight of, and one that is seen close to where it was: the same, or a new
/// one.
World old_or_new() {
  World world(flickering());
  for (int i = 0; i < 6; ++i) apply(world, {frame(i, {at(2, 2, 0.05)})});
  for (int i = 6; i < 10; ++i) apply(world, {frame(i, {})});
  for (int i = 10; i < 13; ++i) apply(world, {frame(i, {at(2.4, 2, 0.05)})});
  return world;
}

TEST(ReadObjects, AThingIsThereWhateverItIsCalled) {
  const World world = old_or_new();
  const auto all = objects(world);
  double expected = 0, by_name = 0;
  int shown = 0;
  for (const ObjectBelief& object : all) {
    expected += object.p;
    by_name += p_by_name(world, object.anchor->birth);
    if (!object.in_best) continue;
    ++shown;
    EXPECT_LT(p_by_name(world, object.anchor->birth), 0.9) << "its name is open";
    EXPECT_GT(object.p, 0.97) << "but not that it is there";
  }
  EXPECT_EQ(shown, 1);
  EXPECT_NEAR(expected, by_name, 1e-9);
  double number = 0;
  const auto distribution =
      count_distribution(*world.belief(), world.belief()->utime, {}, -1, *world.background());
  for (std::size_t n = 0; n < distribution.size(); ++n)
    number += static_cast<double>(n) * distribution[n];
  EXPECT_NEAR(expected, number, 1e-9);
}

/// Which of two objects is which is an open question, and stays one.
TEST(ReadObjects, WhoIsWhereStaysOpen) {
  World world(small_world(R"({"classes": {"default": {"models": [
      {"kind": "constant_position", "position_psd": 0.2}]}},
      "hypotheses": {"max": 100, "scan_depth": 20}})"));
  for (int i = 0; i < 5; ++i) apply(world, {frame(i, {at(1, 1, 0.05), at(3, 1, 0.05)})});
  for (int i = 25; i < 28; ++i) apply(world, {frame(i, {at(1, 3, 0.05), at(3, 3, 0.05)})});
  int open = 0;
  for (const ObjectBelief& object : objects(world)) {
    if (!object.in_best) continue;
    EXPECT_NEAR(object.p, p_by_name(world, object.anchor->birth), 0.2);
    open += object.moments(*world.background()).covariance(0, 0) > 0.3;
  }
  EXPECT_EQ(open, 2);
}

/// Over random scenes: as many objects as anchors, and nobody more than once.
TEST(ReadObjects, TheNumbersAreThoseOfTheAnchors) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    const auto scene = enumeration::random_scene(random, enumeration::random_variety(random));
    Knowledge knowledge = scene.knowledge;
    knowledge.limits = Limits{};
    World world(knowledge);
    apply(world, scene.frames);
    double expected = 0, number = 0;
    for (const ObjectBelief& object : objects(world)) {
      double sum = 0;
      for (const auto& version : object.versions) sum += version.weight(object.p);
      EXPECT_NEAR(sum, 1, 1e-9);
      expected += object.p;
    }
    const auto distribution =
        count_distribution(*world.belief(), world.belief()->utime, {}, -1, *world.background());
    for (std::size_t n = 0; n < distribution.size(); ++n)
      number += static_cast<double>(n) * distribution[n];
    EXPECT_NEAR(expected, number, 1e-6) << "seed " << seed;
  }
}

}  // namespace
}  // namespace anchord
