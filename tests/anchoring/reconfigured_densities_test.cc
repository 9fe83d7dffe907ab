// What a world believes of places moves on with it when its configuration changes.

#include <gtest/gtest.h>

#include "tests/anchoring/older_checkpoint.h"
#include "tests/anchoring/reconfigured.h"

namespace anchord {
namespace {

TEST(Reconfigure, UntilTheChangeAllMovesAsItDid) {
  const auto with_rate = [](const char* rate) {
    return small_world(R"({"hypotheses": {"min_existence": 0}, "classes": {"default": {
        "departure_rate": )" +
                       std::string(rate) + R"(, "arrival_rate": 0.001,
        "models": [{"kind": "constant_position", "position_psd": 0.01},
                   {"kind": "somewhere", "place": "hall", "rate": 0.1}]}}})");
  };
  World world(with_rate("0.1"));
  apply(world, {frame(0, {at(1, 1)}), frame(1, {at(1, 1)})});
  apply(world, {blink(9)});
  const World next = changed(world, with_rate("0.5"));
  expect_same_answers(next, world);
  // Of what a look has touched as well.
  EXPECT_NEAR(expected_unseen(next, "cup"), expected_unseen(world, "cup"), 1e-9);
  World later = next;
  apply(later, {blink(11)});
  EXPECT_NEAR(find(later, "cup-1").p, find(next, "cup-1").p * std::exp(-0.5 * 2), 1e-9);
}

TEST(Reconfigure, DensitiesFollowTheModels) {
  const auto with_models = [](const std::string& models) {
    return small_world(R"({"classes": {"default": {"models": )" + models + "}}}");
  };
  World world(with_models(R"([{"kind": "constant_position", "position_psd": 0},
                              {"kind": "somewhere", "place": "table", "rate": 0.1},
                              {"kind": "somewhere", "place": "hall", "rate": 0.3}])"));
  apply(world, {frame(0, {at(1, 1)}), frame(1, {at(1, 1)}), blink(5)});
  const ObjectBelief before = anchors_by_name(world)[0];
  const auto weight = [](const ObjectBelief& object, std::size_t m) {
    return object.versions[0].leaf.models[m].weight;
  };
  // In another order, with one that moves beside them.
  const World next = changed(world, with_models(R"([
      {"kind": "somewhere", "place": "hall", "rate": 0.3},
      {"kind": "constant_velocity", "initial_velocity_variance": 0.25},
      {"kind": "constant_position", "position_psd": 0},
      {"kind": "somewhere", "place": "table", "rate": 0.1}])"));
  const ObjectBelief after = anchors_by_name(next)[0];
  EXPECT_NEAR(after.p, before.p, kRounding);
  EXPECT_NEAR(weight(after, 0), weight(before, 2), kRounding);
  EXPECT_EQ(weight(after, 1), 0);
  EXPECT_NEAR(weight(after, 2), weight(before, 0), kRounding);
  EXPECT_NEAR(weight(after, 3), weight(before, 1), kRounding);
  // Without one of the places: into the first of what is left.
  const World less = changed(world, with_models(R"([
      {"kind": "constant_velocity", "initial_velocity_variance": 0.25},
      {"kind": "somewhere", "place": "hall", "rate": 0.3}])"));
  const ObjectBelief left = anchors_by_name(less)[0];
  EXPECT_NEAR(left.p, before.p, kRounding);
  EXPECT_NEAR(weight(left, 0), weight(before, 0), kRounding);
  EXPECT_NEAR(weight(left, 1), weight(before, 1) + weight(before, 2), kRounding);
  const auto& moving = std::get<Kinematic>(left.versions[0].leaf.models[0].density);
  EXPECT_NEAR(moving.position.x(), 1, 1e-9);
  EXPECT_EQ(moving.vv(0, 0), 0.25);
}

TEST(Reconfigure, PlacesMayChangeAndGo) {
  const auto with_table = [](const char* polygon) {
    return knowledge_from(
        std::string(R"({"world": {"dimensions": 2, "bounds": {"min": [0, 0],
        "max": [6, 4]}, "cell": 0.25}, "hypotheses": {"min_existence": 0}, "places": [)") +
        polygon + R"(], "classes": {"default": {"undetected_intensity": 0.01, "arrival_rate": 0,
        "models": [{"kind": "constant_position"}, {"kind": "somewhere", "rate": 0.01}]}}})");
  };
  const Knowledge square =
      with_table(R"({"name": "table", "polygon": [[1, 1], [2, 1], [2, 2], [1, 2]]})");
  World world(square);
  apply(world, {frame(0, {at(1.5, 1.5)}), frame(1, {at(1.5, 1.5)})});
  apply(world, in_place(event(Event::Kind::kPlaced, 1.1, "object-1"), "table"));
  View half;  // sees the lower half of it, in vain
  half.type = View::Type::kPolygon;
  half.points = {{0, 0}, {6, 0}, {6, 1.5}, {0, 1.5}};
  Frame look = frame(2, {});
  look.view = half;
  apply(world, {look});
  const auto in = [](const World& w) {
    return std::get<Somewhere>(leaf_of(w, "object-1").models[1].density);
  };
  const double low = in(world).density({1.5, 1.1, 0}), high = in(world).density({1.5, 1.9, 0});
  ASSERT_LT(low, high);
  // A longer table: heights stay as they were; what it was not before nobody has looked at.
  const World longer = changed(
      world, with_table(R"({"name": "table", "polygon": [[1, 1], [3, 1], [3, 2], [1, 2]]})"));
  EXPECT_NEAR(find(longer, "object-1").p, find(world, "object-1").p, kRounding);
  const Somewhere there = in(longer);
  EXPECT_NEAR(there.density({1.5, 1.1, 0}) / there.density({1.5, 1.9, 0}), low / high, 1e-9);
  EXPECT_GT(there.density({2.5, 1.1, 0}), there.density({1.5, 1.1, 0}));
  double mass = 0;
  for (std::size_t i = 0; i < there.footprint()->cells.size(); ++i)
    mass += there.mass_in(static_cast<int>(i));
  EXPECT_NEAR(mass, 1, 1e-12);
  // Without the table: anywhere that its class may be.
  World gone = changed(world, with_table(""));
  EXPECT_NEAR(find(gone, "object-1").p, find(world, "object-1").p, kRounding);
  EXPECT_NEAR(in(gone).density({5, 3, 0}), 1.0 / 24, 1e-9);  // 6 m x 4 m
  apply(gone, {frame(3, {at(1.5, 1.5)})});
}

TEST(Reconfigure, WhatNobodyHasSeenIsKeptPerCell) {
  World world(small_world());
  View west;
  west.type = View::Type::kPolygon;
  west.points = {{0, 0}, {3, 0}, {3, 4}, {0, 4}};
  Frame look = frame(1, {});
  look.view = west;
  apply(world, {frame(0, {at(5, 3)}), look});
  const double cups = expected_unseen(world, "cup");
  for (const char* more : {R"({"world": {"cell": 0.5}})", R"({"world": {"cell": 0.125}})",
                           R"({"world": {"bounds": {"min": [-2, -2], "max": [6, 4]}}})"}) {
    SCOPED_TRACE(more);
    const World next = changed(world, small_world(more));
    const double outside = next.background()->knowledge.bounds_min.x() < 0
                               ? 0.01 * (8 * 6 - 6 * 4)  // as at the start
                               : 0;
    // The view's edge lies on cells' edges.
    EXPECT_NEAR(expected_unseen(next, "cup"), cups + outside, 1e-9);
    EXPECT_NEAR(find(next, "cup-1").p, find(world, "cup-1").p, kRounding);
  }
  const World next = changed(world, small_world(R"({
      "attributes": {"class": {"symbols": ["bowl", "box", "cup"]}},
      "classes": {"bowl": {"undetected_intensity": 0.5, "arrival_rate": 0.1}}})"));
  EXPECT_NEAR(expected_unseen(next, "cup"), cups, kRounding);
  EXPECT_NEAR(expected_unseen(next, "bowl"), 0.5 * 24, 1e-9);  // it begins now
  World later = next;
  apply(later, {blink(2)});
  EXPECT_NEAR(expected_unseen(later, "bowl"), (0.5 + 0.1) * 24, 1e-9);
}

TEST(Reconfigure, WhatArrivesOnTheMoveGoesOn) {
  const OlderScene scene = older_scene();
  World world(scene.knowledge);
  for (const Accepted& step : scene.before) take(world, step);
  Knowledge faster = scene.knowledge;
  faster.classes[1].arrivals[0].rate *= 3;
  const World next = changed(world, faster);
  const auto expected = [](const World& w, int c) {
    const Background& background = *w.background();
    MovingIntensity moving = w.belief()->moving[c];
    moving.advance(w.belief()->seconds(w.belief()->utime));
    return moving.expected(background.knowledge.world());
  };
  EXPECT_GT(expected(world, 1), 0);
  EXPECT_NEAR(expected(next, 1), expected(world, 1), 1e-9);
  expect_same_answers(next, world);
}

}  // namespace
}  // namespace anchord
