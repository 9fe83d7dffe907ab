#include "api/event_json.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

using Kind = Event::Kind;
using nlohmann::json;

const json kPlaced = json::parse(R"({"utime": 1700000000000000, "event": "placed", "robot": "amigo",
    "object": "cup-1", "place": "table", "position": [1, 2, 0.8],
    "covariance": [0.1, 0, 0, 0, 0.2, 0, 0, 0, 0.3], "colour": "ignored"})");
const json kMissing = json::parse(R"({"utime": 1700000000000000, "event": "missing",
    "object": "cup-1", "sensor": "eye", "regions": [
      {"center": [1, 2, 0.8], "covariance": [0.1, 0, 0, 0, 0.2, 0, 0, 0, 0.3], "radius": 2.8,
       "p": 0.95},
      {"polygon": [[0, 0], [1, 0], [1, 1]], "z": [0, 1.5]}]})");

TEST(EventJson, ReadsEveryMember) {
  const auto placed = event_from_json(kPlaced);
  ASSERT_TRUE(placed.ok()) << placed.error().text();
  EXPECT_EQ(placed->kind, Kind::kPlaced);
  EXPECT_EQ(placed->utime, 1700000000000000);
  EXPECT_EQ(placed->robot, "amigo");
  EXPECT_EQ(placed->object, "cup-1");
  EXPECT_EQ(placed->place, "table");
  EXPECT_EQ((*placed->position)[2], 0.8);
  EXPECT_EQ((*placed->covariance)[8], 0.3);
  const auto missing = event_from_json(kMissing);
  ASSERT_TRUE(missing.ok()) << missing.error().text();
  EXPECT_EQ(missing->sensor, "eye");
  ASSERT_EQ(missing->regions.size(), 2u);
  EXPECT_EQ(missing->regions[0].kind, RegionOfInterest::Kind::kEllipsoid);
  EXPECT_EQ(missing->regions[0].radius, 2.8);
  EXPECT_EQ(missing->regions[0].p, 0.95);
  EXPECT_EQ(missing->regions[1].kind, RegionOfInterest::Kind::kPrism);
  EXPECT_EQ(missing->regions[1].polygon[2][1], 1);
  EXPECT_EQ(missing->regions[1].z[1], 1.5);
  const auto named = parse_event(
      R"({"utime": 1700000000000000, "event": "named", "object": "cup-1", "name": "my mug"})");
  ASSERT_TRUE(named.ok());
  EXPECT_EQ(named->other, "my mug");
  const auto undone =
      parse_event(R"({"utime": 1700000000000000, "event": "undone", "number": 12})");
  ASSERT_TRUE(undone.ok());
  EXPECT_EQ(undone->undone, 12);
}

TEST(EventJson, WhatIsWrittenReadsTheSame) {
  for (int k = 0; k < 10; ++k) {
    Event e = event(static_cast<Kind>(k), 1, "cup-1");
    e.robot = "amigo";
    e.other = "my mug";
    e.place = "table";
    e.sensor = "eye";
    e.position = {0.1, 0.2, 1.0 / 3};
    e.covariance = {0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1};
    e.undone = 7;
    e.regions = event_from_json(kMissing)->regions;
    const auto read = parse_event(to_json(e).dump());
    ASSERT_TRUE(read.ok()) << read.error().text();
    EXPECT_EQ(*read, e) << to_string(e.kind);
    EXPECT_EQ(to_json(e)["event"], to_string(e.kind));
  }
  const Event forget = named(1, "cup-1", "");
  EXPECT_EQ(*parse_event(to_json(forget).dump()), forget);
}

TEST(EventJson, APositionHasTheWorldsNumbers) {
  json flat = kPlaced;
  flat["position"] = {1, 2};
  EXPECT_EQ(event_from_json(flat, 3).error().field, "position");
  flat["covariance"] = {0.1, 0.01, 0.01, 0.2};
  const auto read = event_from_json(flat, 2);
  ASSERT_TRUE(read.ok()) << read.error().text();
  EXPECT_EQ(*read->position, (std::array<double, 3>{1, 2, 0}));
  EXPECT_EQ(*read->covariance, (std::array<double, 9>{0.1, 0.01, 0, 0.01, 0.2, 0, 0, 0, 0}));
  EXPECT_TRUE(event_from_json(kPlaced, 2).ok()) << "the third is not looked at";
}

TEST(EventJson, RefusesAndNamesTheField) {
  struct Fault {
    const json& event;
    std::function<void(json&)> make;
    const char* field;
  };
  const std::vector<Fault> faults{
      {kPlaced, [](json& e) { e.erase("utime"); }, "utime"},
      {kPlaced, [](json& e) { e["utime"] = 1.5; }, "utime"},
      {kPlaced, [](json& e) { e.erase("event"); }, "event"},
      {kPlaced, [](json& e) { e["event"] = "stolen"; }, "event"},
      {kPlaced, [](json& e) { e["event"] = 3; }, "event"},
      {kPlaced, [](json& e) { e["object"] = 1; }, "object"},
      {kPlaced, [](json& e) { e["object"] = std::string(257, 'a'); }, "object"},
      {kPlaced, [](json& e) { e["robot"] = "a\nb"; }, "robot"},
      {kPlaced, [](json& e) { e["place"] = json::array(); }, "place"},
      {kPlaced, [](json& e) { e["position"] = {1}; }, "position"},
      {kPlaced, [](json& e) { e["position"][1] = "2"; }, "position[1]"},
      {kPlaced, [](json& e) { e["covariance"].push_back(0); }, "covariance"},
      {kPlaced, [](json& e) { e["event"] = "named"; }, "name"},
      {kPlaced, [](json& e) { e["event"] = "undone"; }, "number"},
      {kPlaced, [](json& e) { e["number"] = "12"; }, "number"},
      {kMissing, [](json& e) { e["sensor"] = 1; }, "sensor"},
      {kMissing, [](json& e) { e["regions"] = json::object(); }, "regions"},
      {kMissing, [](json& e) { e["regions"] = json(257, e["regions"][0]); }, "regions"},
      {kMissing, [](json& e) { e["regions"][1] = 1; }, "regions[1]"},
      {kMissing, [](json& e) { e["regions"][0].erase("center"); }, "regions[0].center"},
      {kMissing,
       [](json& e) {
         e["regions"][0]["center"] = {1, 2};
       },
       "regions[0].center"},
      {kMissing, [](json& e) { e["regions"][0].erase("radius"); }, "regions[0].radius"},
      {kMissing, [](json& e) { e["regions"][0]["covariance"] = {1}; }, "regions[0].covariance"},
      {kMissing, [](json& e) { e["regions"][0]["p"] = "all"; }, "regions[0].p"},
      {kMissing, [](json& e) { e["regions"][1]["polygon"][2] = {1}; }, "regions[1].polygon[2]"},
      {kMissing, [](json& e) { e["regions"][1]["z"] = {1}; }, "regions[1].z"},
  };
  for (const Fault& fault : faults) {
    json bad = fault.event;
    fault.make(bad);
    const auto refused = event_from_json(bad);
    ASSERT_FALSE(refused.ok()) << fault.field;
    EXPECT_EQ(refused.error().field, fault.field);
    EXPECT_FALSE(refused.error().message.empty());
  }
  EXPECT_FALSE(parse_event("[]").ok());
  EXPECT_FALSE(parse_event("{").ok());
}

TEST(EventJson, BeliefsTellTheAliasAndWhoHoldsIt) {
  World world(small_world());
  apply(world, {frame(1, {at(1, 1)})});
  EXPECT_FALSE(json::parse(everything(world))["objects"][0].contains("alias"));
  apply(world, named(1, "cup-1", "my mug"));
  Event grasped = event(Kind::kGrasped, 1, "cup-1");
  grasped.robot = "amigo";
  apply(world, grasped);
  const json object = json::parse(everything(world))["objects"][0];
  EXPECT_EQ(object["alias"], "my mug");
  EXPECT_EQ(object["held_by"], "amigo");
}

}  // namespace
}  // namespace anchord
