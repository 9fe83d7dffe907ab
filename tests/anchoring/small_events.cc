#include "tests/anchoring/small_events.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "api/world_line.h"

namespace anchord {

Event event(Event::Kind kind, double seconds, const std::string& object) {
  Event e;
  e.kind = kind;
  e.utime = at_second(seconds);
  e.object = object;
  return e;
}

Event in_place(Event e, const std::string& place) {
  e.place = place;
  return e;
}

Event at_position(Event e, double x, double y) {
  e.position = {x, y, 0};
  return e;
}

Event carried(double seconds, double x, double y, const std::string& robot) {
  Event e = at_position(event(Event::Kind::kCarried, seconds), x, y);
  e.robot = robot;
  return e;
}

Event named(double seconds, const std::string& object, const std::string& alias) {
  Event e = event(Event::Kind::kNamed, seconds, object);
  e.other = alias;
  return e;
}

Event joined(double seconds, const std::string& object, const std::string& other) {
  Event e = event(Event::Kind::kJoined, seconds, object);
  e.other = other;
  return e;
}

Event undone(double seconds, std::int64_t number) {
  Event e = event(Event::Kind::kUndone, seconds);
  e.undone = number;
  return e;
}

RegionOfInterest box_of_interest(double x_min, double y_min, double x_max, double y_max) {
  RegionOfInterest region;
  region.kind = RegionOfInterest::Kind::kPrism;
  region.polygon = {{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}};
  region.z = {0, 3};
  return region;
}

Event missing(double seconds, const std::string& object, const RegionOfInterest& region) {
  Event e = event(Event::Kind::kMissing, seconds, object);
  e.sensor = "eye";
  e.regions = {region};
  return e;
}

std::int64_t apply(World& world, const Event& e) {
  const auto number = world.apply(e);
  EXPECT_TRUE(number.ok()) << number.error().text();
  return number.ok() ? *number : -1;
}

ObjectBelief find(const World& world, const std::string& called) {
  for (auto& object : objects(world))
    if (object.anchor->is_called(called)) return object;
  ADD_FAILURE() << "no object is called " << called;
  std::abort();
}

const Leaf& leaf_of(const World& world, const std::string& called) {
  const auto at = find_anchor(*world.belief(), called);
  EXPECT_TRUE(at.has_value()) << called;
  const auto& leaves = world.belief()->clusters[at->cluster]->anchors[at->anchor].leaves;
  EXPECT_EQ(leaves.size(), 1u);
  return *leaves[0];
}

std::string every_object(const World& world) {
  WorldLineOptions options;
  options.all = true;
  return world_line(*world.belief(), *world.background(), options)["objects"].dump();
}

}  // namespace anchord
