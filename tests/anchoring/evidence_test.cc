// What labels do to a belief in the long run, and what time does to attributes.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_events.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

/// Sums of a handful of exponentials.
constexpr double kRounding = 1e-12;

/// The one object that there is.
ObjectBelief the_object(const World& world) {
  const auto all = objects(world);
  EXPECT_EQ(all.size(), 1u);
  return all.front();
}

/// Reports one object, `labels` times, as a symbol of an attribute with probability p; 1 Hz.
void report(World& world, int labels, const std::string& attribute, const std::string& symbol,
            double p, const std::string& sensor = "eye") {
  for (int i = 0; i < labels; ++i) {
    const Utime last = world.belief()->utime;
    Frame next = frame(0, {at(1, 1, attribute, symbol, p)}, sensor);
    next.utime = last == 0 ? at_second(0) : last + from_seconds(1);
    if (last != 0) next.detections[0].object = the_object(world).anchor->id();
    apply(world, {next});
  }
}

/// One world in which every report is of the same object.
Knowledge labelled(const std::string& limits = "") {
  return small_world(R"({"sensors": {"default": {"identity_doubt": 1e-9}},
                         "hypotheses": {"max": 1, "min_existence": 0.5)" +
                     limits + "}}");
}

double class_belief(const World& world, int c) {
  return the_object(world).classes(*world.background())[c];
}

double symbol_belief(const World& world, const char* attribute, int symbol) {
  const int index = world.background()->knowledge.find_attribute(attribute);
  return the_object(world).shown().attribute(index)->symbols[symbol];
}

/// A label of 0.9 against 0.1 makes a class nine times as probable against the other; from 1e-6
/// up to even takes ln 1e6 / ln 9 = 6.3 of them.
constexpr int kWayBack = 7;

TEST(Evidence, AClassComesBackAfterAnyNumberOfWrongLabels) {
  for (const int wrong : {20, 100, 400}) {
    World world(labelled());
    report(world, 20, "class", "cup", 0.9);
    report(world, wrong, "class", "box", 0.9);
    EXPECT_NEAR(class_belief(world, 0), 1e-6, 1e-11) << wrong << " wrong ones";
    report(world, kWayBack, "class", "cup", 0.9);
    EXPECT_GT(class_belief(world, 0), 0.5) << wrong << " wrong ones";
    EXPECT_EQ(the_object(world).anchor->id(), "cup-1");
  }
}

TEST(Evidence, WithoutAFloorItDoesNot) {
  World world(labelled(R"(, "min_symbol": 0)"));
  report(world, 20, "class", "cup", 0.9);
  report(world, 100, "class", "box", 0.9);
  EXPECT_NEAR(std::log(class_belief(world, 0)), -80 * std::log(9), 1e-6) << "a rounded sum";
  report(world, kWayBack, "class", "cup", 0.9);
  EXPECT_LT(class_belief(world, 0), 1e-60);
}

TEST(Evidence, AnAttributeComesBackToo) {
  World world(labelled());
  report(world, 20, "color", "red", 0.9);  // 0.05 for each of the others: 18 times as probable
  report(world, 100, "color", "blue", 0.9);
  EXPECT_NEAR(symbol_belief(world, "color", 0), 1e-6, 1e-11);
  report(world, 5, "color", "red", 0.9);  // ln 1e6 / ln 18 = 4.8
  EXPECT_GT(symbol_belief(world, "color", 0), 0.5);
}

TEST(Evidence, TheFloorIsConfigured) {
  World world(labelled(R"(, "min_symbol": 0.01)"));
  report(world, 100, "class", "box", 0.9);
  EXPECT_NEAR(class_belief(world, 0), 0.01, 1e-3) << "normalised after it";
  report(world, 3, "class", "cup", 0.9);  // ln 99 / ln 9 = 2.1
  EXPECT_GT(class_belief(world, 0), 0.5);
}

TEST(Evidence, WhatOneSensorCannotSeeAnotherMayTell) {
  World world(small_world(R"({"sensors": {
      "default": {"identity_doubt": 1e-9},
      "eye": {"detection_probability": {"cup": 0}}}})"));
  report(world, 20, "class", "box", 0.9);
  report(world, kWayBack + 1, "class", "cup", 0.9, "other_eye");
  EXPECT_GT(class_belief(world, 0), 0.5);
}

/// A banana turns yellow in a day, and brown in three.
constexpr const char* kRipens = R"({
  "attributes": {"class": {"kind": "categorical", "symbols": ["banana", "box"]},
                 "color": {"kind": "categorical", "symbols": ["green", "yellow", "brown", "red"]}},
  "classes": {"banana": {"changes": {"size": {"drift": 1e-8}, "color": {"transitions": [
                  {"from": "green", "to": "yellow", "rate": 1.2e-5},
                  {"from": "yellow", "to": "brown", "rate": 4e-6}]}}},
              "box": {"changes": {"color": {"redraw": 1e-6}}}}})";

Frame first_seen(const std::string& object_class, const std::string& color, double seconds = 0) {
  Frame out = frame(seconds, {at(1, 1, 0.04)});  // 0.2 m: where it is says little
  out.detections[0].attributes.push_back({"class", SymbolReport{{{object_class, 1}}}});
  out.detections[0].attributes.push_back({"color", SymbolReport{{{color, 1}}}});
  out.detections[0].attributes.push_back({"size", ScalarReport{0.1, 1e-4}});
  return out;
}

TEST(Evidence, ABananaRipens) {
  World world(small_world(kRipens));
  apply(world, {first_seen("banana", "green")});
  const int color = world.background()->knowledge.find_attribute("color");
  const int size = world.background()->knowledge.find_attribute("size");
  const PoolVector<double> fresh = the_object(world).shown().attribute(color)->symbols;
  const double day = 86400;
  apply(world, {blink(day)});
  const Leaf leaf = the_object(world).shown();
  const PoolVector<double>& now = leaf.attribute(color)->symbols;
  // Bateman's equations for the chain a -> b -> c.
  const double a = 1.2e-5, b = 4e-6, ea = std::exp(-a * day), eb = std::exp(-b * day);
  const double green = fresh[0] * ea, red = fresh[3];
  const double yellow = fresh[1] * eb + fresh[0] * a / (b - a) * (ea - eb);
  EXPECT_NEAR(now[0], green, kRounding);
  EXPECT_NEAR(now[1], yellow, kRounding);
  EXPECT_NEAR(now[2], 1 - green - yellow - red, kRounding);
  EXPECT_NEAR(now[3], red, kRounding) << "takes no part";
  EXPECT_NEAR(leaf.attribute(size)->variance, 1e-4 + 1e-8 * day, kRounding);
}

TEST(Evidence, ABoxFadesTowardsAnyColor) {
  World world(small_world(kRipens));
  apply(world, {first_seen("box", "green")});
  const double fresh = symbol_belief(world, "color", 0);
  apply(world, {blink(5e5)});
  EXPECT_NEAR(symbol_belief(world, "color", 0), 0.25 + (fresh - 0.25) * std::exp(-0.5), kRounding);
}

TEST(Evidence, AYellowBananaIsTheGreenOneOfYesterday) {
  const auto last_seen = [](const Knowledge& knowledge) {
    World world(knowledge);
    apply(world, {first_seen("banana", "green"), first_seen("banana", "yellow", 86400)});
    return objects(world).front().shown().last_seen;
  };
  Knowledge unchanging = small_world(kRipens);
  for (ObjectClass& c : unchanging.classes) c.changes.clear();
  EXPECT_EQ(last_seen(small_world(kRipens)), at_second(86400));
  EXPECT_EQ(last_seen(unchanging), at_second(0)) << "two bananas";
}

TEST(Evidence, ItRipensInTheHandToo) {
  World world(small_world(kRipens));
  apply(world, {first_seen("banana", "green")});
  apply(world, event(Event::Kind::kGrasped, 0, "banana-1"));
  const double fresh = symbol_belief(world, "color", 0);
  apply(world, {blink(86400)});
  EXPECT_NEAR(symbol_belief(world, "color", 0), fresh * std::exp(-1.2e-5 * 86400), kRounding);
}

}  // namespace
}  // namespace anchord
