// A world whose configuration changes goes on from what it believes.

#include "anchoring/reconfigure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "anchoring/checkpoint.h"
#include "tests/anchoring/older_checkpoint.h"
#include "tests/anchoring/reconfigured.h"

namespace anchord {
namespace {

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
