// A world whose configuration changes goes on from what it believes.

#include "anchoring/reconfigure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "anchoring/checkpoint.h"
#include "tests/anchoring/older_checkpoint.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_events.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr double kRounding = 1e-12;

World changed(const World& world, const Knowledge& knowledge) {
  auto next = reconfigured(world, knowledge);
  if (!next) ADD_FAILURE() << next.error().text();
  return next ? *std::move(next) : World(knowledge);
}

/// The belief as bytes, whatever steps may still be folded again.
std::vector<std::uint8_t> bytes_of(const World& world) {
  WorldState state;
  state.before = world.belief();
  return write_checkpoint(state, *world.background());
}

/// By id: p, and what answers say of classes and attributes, by name.
std::map<std::string, std::map<std::string, double>> answers(const World& world) {
  const Knowledge& known = world.background()->knowledge;
  std::map<std::string, std::map<std::string, double>> out;
  for (const ObjectBelief& object : anchors_by_name(world)) {
    auto& said = out[object.anchor->id()];
    said["p"] = object.p;
    for (const auto& version : object.versions) {
      const double weight = version.probability * version.leaf.existence;
      for (std::size_t c = 0; c < known.classes.size(); ++c)
        said["class " + known.classes[c].name] += weight * version.leaf.classes[c];
      for (const AttributeBelief& belief : version.leaf.attributes) {
        const Attribute& attribute = known.attributes[belief.attribute];
        for (std::size_t s = 0; s < belief.symbols.size(); ++s)
          said[attribute.name + " " + attribute.symbols[s]] += weight * belief.symbols[s];
        said[attribute.name] += weight * belief.mean;
      }
      for (const ModelState& state : version.leaf.models)
        if (const auto* kinematic = std::get_if<Kinematic>(&state.density)) {
          said["x"] += weight * state.weight * kinematic->position.x();
          said["y"] += weight * state.weight * kinematic->position.y();
        } else {
          said["in places"] += weight * state.weight;
        }
    }
  }
  return out;
}

/// Equal where both say something; what only one of them has is 0.
void expect_same_answers(const World& a, const World& b, double tolerance = kRounding) {
  auto in_a = answers(a), in_b = answers(b);
  ASSERT_EQ(in_a.size(), in_b.size());
  for (const auto& [id, said] : in_a) {
    ASSERT_TRUE(in_b.count(id)) << id;
    for (const auto& [what, value] : said)
      EXPECT_NEAR(value, in_b[id][what], tolerance) << id << ' ' << what;
    for (const auto& [what, value] : in_b[id])
      EXPECT_NEAR(value, in_a[id][what], tolerance) << id << ' ' << what;
  }
}

double expected_unseen(const World& world, const std::string& name) {
  const Background& background = *world.background();
  const Belief& belief = *world.belief();
  const int c = background.knowledge.find_class(name);
  double sum = 0;
  for (int cell = 0; cell < background.grid.size(); ++cell)
    sum += belief.undetected[c].at(cell, belief.seconds(belief.utime)) * background.cell_volume();
  return sum;
}

void expect_refused(const World& world, const Knowledge& knowledge, const std::string& field,
                    const std::vector<std::string>& named) {
  const std::string before = everything(world);
  const auto next = reconfigured(world, knowledge);
  ASSERT_FALSE(next.ok()) << field;
  EXPECT_EQ(next.error().code, ErrorCode::kConflict);
  EXPECT_EQ(next.error().field, field);
  for (const std::string& name : named)
    EXPECT_NE(next.error().message.find(name), std::string::npos) << next.error().message;
  EXPECT_EQ(everything(world), before);
}

/// small_world() with other symbols of an attribute.
Knowledge with_symbols(const std::string& attribute, const std::string& symbols) {
  return small_world(R"({"attributes": {")" + attribute + R"(": {"symbols": )" + symbols + "}}}");
}

TEST(Reconfigure, ToTheSameKnowledgeGoesOnToTheBit) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    auto variety = enumeration::random_variety(random);
    variety.late = false;
    auto scene = enumeration::random_scene(random, variety);
    for (const Limits& limits : {scene.knowledge.limits, Limits{}}) {
      scene.knowledge.limits = limits;
      World all(scene.knowledge), parts(scene.knowledge);
      for (const Frame& frame : scene.frames) {
        parts = changed(parts, scene.knowledge);
        ASSERT_TRUE(all.apply(frame).ok());
        ASSERT_TRUE(parts.apply(frame).ok());
        ASSERT_EQ(everything(parts), everything(all));
        ASSERT_EQ(bytes_of(parts), bytes_of(all));
      }
    }
  }
}

TEST(Reconfigure, ToTheSameKnowledgeKeepsWhatEventsDid) {
  const OlderScene scene = older_scene();
  World all(scene.knowledge), parts(scene.knowledge);
  for (const Accepted& step : scene.before) {
    const auto* frame = std::get_if<Frame>(&step.what);
    if (frame && frame->utime < all.belief()->utime) continue;  // nothing is folded twice
    parts = changed(parts, scene.knowledge);
    take(all, step);
    take(parts, step);
    ASSERT_EQ(bytes_of(parts), bytes_of(all));
  }
  EXPECT_FALSE(all.belief()->set_aside.empty());
}

/// A class and symbols more, where others stood in the order.
Knowledge more_of_all(Knowledge knowledge) {
  if (knowledge.class_attribute >= 0) {
    ObjectClass extra = knowledge.classes.front();
    extra.name = "extra";
    extra.looks_like = -1;
    extra.phantom = false;
    for (ObjectClass& c : knowledge.classes) c.looks_like += c.looks_like >= 0 ? 1 : 0;
    knowledge.classes.insert(knowledge.classes.begin(), extra);
    auto& symbols = knowledge.attributes[knowledge.class_attribute].symbols;
    symbols.insert(symbols.begin(), "extra");
  }
  const auto refit = [&](Sensor& sensor) {
    auto& p = sensor.detection_probability;
    p.insert(p.begin(), knowledge.classes.size() - p.size(), 0.5);
    sensor.prior.resize(knowledge.attributes.size());
    for (std::size_t a = 0; a < knowledge.attributes.size(); ++a) {
      const std::size_t n = knowledge.attributes[a].symbols.size();
      if (n > 0) sensor.prior[a].assign(n, 1.0 / static_cast<double>(n));
    }
    sensor.confusion.assign(knowledge.attributes.size(), {});
    sensor.clutter_looks.clear();
    sensor.score_calibration.of.clear();
    sensor.real_share.of.clear();
    sensor.score_memory.of.clear();
  };
  for (Attribute& attribute : knowledge.attributes)
    if (attribute.kind == Attribute::Kind::kCategorical && attribute.name != "class")
      attribute.symbols.push_back("beige");
  for (Sensor& sensor : knowledge.sensors) refit(sensor);
  refit(knowledge.default_sensor);
  return knowledge;
}

TEST(Reconfigure, ThereAndBackKeepsEveryAnswer) {
  int with_classes = 0, with_attributes = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    auto variety = enumeration::random_variety(random);
    variety.late = false;
    const auto scene = enumeration::random_scene(random, variety);
    World world(scene.knowledge);
    for (const Frame& frame : scene.frames) ASSERT_TRUE(world.apply(frame).ok());
    with_classes += scene.knowledge.class_attribute >= 0;
    with_attributes += scene.knowledge.attributes.size() > 1;
    const World there = changed(world, more_of_all(scene.knowledge));
    expect_same_answers(there, world);
    const World back = changed(there, scene.knowledge);
    expect_same_answers(back, world);
    for (const ObjectClass& c : scene.knowledge.classes)
      EXPECT_NEAR(expected_unseen(back, c.name), expected_unseen(world, c.name), kRounding);
  }
  EXPECT_GT(with_classes, 50);
  EXPECT_GT(with_attributes, 50);
}

TEST(Reconfigure, KeepsNamesAliasesHoldersAndCounts) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1, "class", "cup", 0.9), at(5, 3, "class", "box", 0.9)}),
                frame(1, {at(1, 1, "class", "cup", 0.9), at(5, 3, "class", "box", 0.9)})});
  apply(world, named(1.1, "cup-1", "mine"));
  Event grasp = event(Event::Kind::kGrasped, 1.2, "box-1");
  grasp.robot = "amigo";
  apply(world, grasp);
  World next = changed(world, with_symbols("class", R"(["bowl", "box", "cup"])"));
  EXPECT_EQ(ids(next), ids(world));
  EXPECT_EQ(next.belief()->frames, world.belief()->frames);
  EXPECT_EQ(next.belief()->births, world.belief()->births);
  EXPECT_EQ(next.belief()->log_evidence, world.belief()->log_evidence);
  EXPECT_EQ(next.belief()->names, (std::vector<std::uint64_t>{0, 1, 1}));
  EXPECT_EQ(find(next, "cup-1").anchor->alias, "mine");
  EXPECT_EQ(find(next, "box-1").anchor->holder, "amigo");
  apply(next, {frame(2, {at(1, 1), at(4, 1, "class", "cup", 0.99)}),
               frame(3, {at(1, 1), at(4, 1, "class", "cup", 0.99)})});
  EXPECT_EQ(find(next, "cup-2").anchor->name, "cup-2");  // counts on
  EXPECT_EQ(next.state().taken, 6);
}

TEST(Reconfigure, WhatIsNewIsLearnedFromTheNextDetectionOn) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1, "color", "red", 0.9)}), frame(1, {at(1, 1)})});
  World next = changed(world, with_symbols("color", R"(["red", "green", "blue", "pink"])"));
  const auto pink = [&] { return answers(next)["cup-1"]["color pink"]; };
  EXPECT_EQ(pink(), 0);
  for (int i = 2; i < 12; ++i) apply(next, {frame(i, {at(1, 1, "color", "pink", 0.9)})});
  EXPECT_GT(pink(), 0.8);
}

TEST(Reconfigure, ASymbolThatNobodyNeedsGoesAndItsShareIsSpread) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1, "color", "red", 0.8)}), frame(1, {at(1, 1)})});
  const auto before = leaf_of(world, "cup-1").attribute(1)->symbols;
  const World next = changed(world, with_symbols("color", R"(["blue", "red"])"));
  const auto after = leaf_of(next, "cup-1").attribute(1)->symbols;
  ASSERT_EQ(after.size(), 2u);
  EXPECT_NEAR(after[0], before[2] / (before[0] + before[2]), kRounding);
  EXPECT_NEAR(after[1], before[0] / (before[0] + before[2]), kRounding);
  EXPECT_NEAR(find(next, "cup-1").p, find(world, "cup-1").p, kRounding);
}

TEST(Reconfigure, WhatIsInUseCannotBeTakenAway) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1, "color", "red", 0.9), at(5, 3, "class", "box", 0.9)}),
                frame(1, {at(1, 1, "color", "red", 0.9), at(5, 3, "class", "box", 0.9)})});
  expect_refused(world, with_symbols("color", R"(["green", "blue"])"), "attributes.color.symbols",
                 {"'red'", "cup-1"});
  expect_refused(world, with_symbols("class", R"(["cup"])"), "classes.box", {"box-1"});
  Knowledge measured = small_world();
  measured.attributes[1].kind = Attribute::Kind::kScalar;
  measured.attributes[1].symbols.clear();
  expect_refused(world, measured, "attributes.color", {"kind", "cup-1"});
}

TEST(Reconfigure, AClassThatGaveNamesStaysEvenIfNoObjectIsOfItAnyMore) {
  World world(small_world());
  apply(world, {frame(0, {at(5, 3, "class", "box", 0.9)}), frame(1, {at(5, 3)})});
  apply(world, event(Event::Kind::kRemoved, 1.1, "box-1"));
  ASSERT_TRUE(ids(world).empty());
  expect_refused(world, with_symbols("class", R"(["cup"])"), "classes.box", {"box-1", "named"});
  EXPECT_TRUE(reconfigured(world, with_symbols("class", R"(["box"])")).ok());
}

TEST(Reconfigure, DimensionsChangeOnlyInAnEmptyWorld) {
  const auto flat = [](const char* dimensions) {
    return knowledge_from(std::string(R"({"world": {"dimensions": )") + dimensions + "}}");
  };
  const Knowledge two = flat(R"(2, "bounds": {"min": [0, 0], "max": [6, 4]})");
  const Knowledge three = flat(R"(3, "bounds": {"min": [0, 0, 0], "max": [6, 4, 3]})");
  World world(two);
  apply(world, {frame(0, {})});
  EXPECT_TRUE(reconfigured(world, three).ok());
  apply(world, {frame(1, {at(1, 1)})});
  expect_refused(world, three, "world.dimensions", {"object-1"});
}

TEST(Reconfigure, AnAliasThatWouldLookLikeANameRefusesTheClass) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1)}), frame(1, {at(1, 1)})});
  apply(world, named(1.1, "cup-1", "mug-3"));
  expect_refused(world, with_symbols("class", R"(["cup", "box", "mug"])"), "classes.mug",
                 {"cup-1", "mug-3"});
}

TEST(Reconfigure, NothingBeforeTheChangeIsFoldedAgain) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1)}), frame(1, {at(1, 1)})});
  World next = changed(world, small_world(R"({"hypotheses": {"max": 7}})"));
  EXPECT_EQ(next.floor(), at_second(1));
  EXPECT_TRUE(next.state().recent.empty());
  ASSERT_TRUE(world.apply(frame(0.9, {at(5, 3)}, "late")).ok());  // it could have been
  const Status late = next.apply(frame(0.9, {at(5, 3)}, "late"));
  ASSERT_FALSE(late.ok());
  EXPECT_EQ(late.error().code, ErrorCode::kConflict);
  EXPECT_EQ(late.error().field, "utime");
  EXPECT_NE(late.error().message.find("lies before the change of the configuration"),
            std::string::npos);
  apply(next, {frame(1.4, {at(1, 1)}), frame(1.2, {at(1, 1)}, "late")});  // after it, in order
  EXPECT_EQ(next.late_frames(), 1u);
  // What was said before takes effect at the change: the belief then knew the cup.
  apply(next, named(0.95, "cup-1", "mine"));
  EXPECT_EQ(find(next, "cup-1").anchor->alias, "mine");
}

TEST(Reconfigure, TheFloorIsInTheCheckpoint) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1)}), frame(1, {at(1, 1)})});
  World next = changed(world, with_symbols("class", R"(["cup", "box", "mug"])"));
  auto state = read_checkpoint(write_checkpoint(next.state(), *next.background()),
                               World(next.background()->knowledge));
  ASSERT_TRUE(state.ok());
  EXPECT_EQ(state->floor, at_second(1));
  World again(next.background()->knowledge);
  ASSERT_TRUE(again.resume(*std::move(state), {}).ok());
  EXPECT_FALSE(again.apply(frame(0.9, {}, "late")).ok());
  apply(next, {frame(2, {at(1, 1)})});
  apply(again, {frame(2, {at(1, 1)})});
  EXPECT_EQ(bytes_of(again), bytes_of(next));
}

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

TEST(Reconfigure, UndoBringsBackWhatWasPutAside) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1, "color", "red", 0.9), at(5, 3)}),
                frame(1, {at(1, 1, "color", "red", 0.9), at(5, 3)})});
  const std::int64_t dropped = apply(world, event(Event::Kind::kDropped, 1.1, "cup-1"));
  ASSERT_EQ(ids(world).size(), 1u);
  World next = changed(world, with_symbols("color", R"(["green", "red"])"));
  apply(next, undone(1.2, dropped));
  EXPECT_EQ(ids(next).size(), 2u);
  EXPECT_GT(leaf_of(next, "cup-1").attribute(1)->symbols[1], 0.8);
  // What would not fit cannot come back; nobody else is called red.
  World without = changed(world, with_symbols("color", R"(["green", "blue"])"));
  const auto undo = without.apply(undone(1.2, dropped));
  ASSERT_FALSE(undo.ok());
  EXPECT_EQ(undo.error().code, ErrorCode::kUnknown);
}

}  // namespace
}  // namespace anchord
