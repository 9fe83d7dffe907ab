#include "knowledge/knowledge.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

TEST(Knowledge, FindsByNameOrSaysMinusOne) {
  Knowledge knowledge;
  knowledge.places = {{"kitchen", "room", -1, 0, {}}, {"table", "surface", 0, 1, {}}};
  knowledge.attributes.resize(2);
  knowledge.attributes[1].name = "color";
  knowledge.classes.resize(3);
  knowledge.classes[2].name = "cup";
  EXPECT_EQ(knowledge.find_place("table"), 1);
  EXPECT_EQ(knowledge.find_place("Table"), -1);
  EXPECT_EQ(knowledge.find_attribute("color"), 1);
  EXPECT_EQ(knowledge.find_attribute("size"), -1);
  EXPECT_EQ(knowledge.find_class("cup"), 2);
  EXPECT_EQ(knowledge.find_class("mug"), -1);
}

TEST(Knowledge, AnUnnamedSensorIsTheDefault) {
  Knowledge knowledge;
  knowledge.default_sensor.clutter_density = 3;
  knowledge.sensors.resize(1);
  knowledge.sensors[0].name = "kinect";
  knowledge.sensors[0].clutter_density = 4;
  EXPECT_EQ(knowledge.sensor("kinect").clutter_density, 4);
  EXPECT_EQ(knowledge.sensor("kinect2").clutter_density, 3);
  EXPECT_EQ(knowledge.sensor("").clutter_density, 3);
}

TEST(Knowledge, AttributesFindSymbolsAndPredicates) {
  Attribute color;
  color.symbols = {"red", "blue"};
  EXPECT_EQ(color.find("blue"), 1);
  EXPECT_EQ(color.find("green"), -1);
  Attribute size;
  size.kind = Attribute::Kind::kScalar;
  size.predicates = {{"small", 0, 1}, {"large", 1, 2}};
  EXPECT_EQ(size.find("large"), 1);
  EXPECT_EQ(size.find("tall"), -1);
}

TEST(Knowledge, TheWorldIsItsBounds) {
  Knowledge knowledge;
  knowledge.bounds_min = {-1, -2, 0};
  knowledge.bounds_max = {3, 4, 2.5};
  EXPECT_EQ(knowledge.world().area(), 24);  // 4 x 6
  EXPECT_EQ(knowledge.world().volume(3), 60);
  EXPECT_TRUE(knowledge.world().contains({2.9, -1.9, 1}, 3));
  EXPECT_FALSE(knowledge.world().contains({2.9, -1.9, 2.6}, 3));
}

TEST(Knowledge, BehaviourModelsAreCalledAsInTheConfiguration) {
  EXPECT_STREQ(to_string(BehaviourModel::Kind::kConstantPosition), "constant_position");
  EXPECT_STREQ(to_string(BehaviourModel::Kind::kConstantVelocity), "constant_velocity");
  EXPECT_STREQ(to_string(BehaviourModel::Kind::kSomewhere), "somewhere");
}

}  // namespace
}  // namespace anchord
