#include "api/world_message.h"

#include <gtest/gtest.h>

#include <anchord/world_t.hpp>

#include "api/world_line.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

TEST(WorldMessage, DecodesWithTheGeneratedTypeToTheBestWorld) {
  World world(small_world(R"({"classes": {"cup": {"extent": [0.1, 0.2, 0.3]}}})"));
  Detection cup = at(1.5, 1.5, "class", "cup", 0.9);
  cup.attributes.push_back({"color", SymbolReport{{{"red", 0.8}}}});
  cup.attributes.push_back({"size", ScalarReport{0.12, 0.0004}});
  cup.yaw = -0.5;
  Detection doubtful = at(4, 2);
  doubtful.score = 0.01;
  apply(world, {frame(0, {cup, at(5, 1), doubtful})});

  const auto bytes = encode_world(*world.belief(), *world.background(), 17);
  world_t message{};
  ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  const Json line = world_line(*world.belief(), *world.background());
  EXPECT_EQ(message.utime, at_second(0));
  EXPECT_EQ(message.seq, 17);
  EXPECT_EQ(message.expected_count, line["expected_count"].get<double>());
  EXPECT_EQ(message.num_hypotheses, line["hypotheses"].get<int>());
  EXPECT_EQ(message.num_clusters, line["clusters"].get<int>());
  ASSERT_EQ(message.num_objects, 2) << "the doubtful one stands in no best world";
  const object_t& object = message.objects[0];
  const Json& shown = line["objects"][0];
  EXPECT_EQ(object.id, "cup-1");
  EXPECT_EQ(object.p, shown["p"].get<double>());
  EXPECT_EQ(object.symbol_class, "cup");
  EXPECT_NEAR(object.class_p, 0.9, 1e-12);
  EXPECT_EQ(object.position[0], shown["position"][0].get<double>());
  EXPECT_EQ(object.position[2], 0) << "a 2-D world";
  EXPECT_EQ(object.covariance[4], shown["covariance"][3].get<double>());
  EXPECT_EQ(object.covariance[8], 0);
  EXPECT_TRUE(object.has_yaw);
  EXPECT_EQ(object.yaw, -0.5);
  EXPECT_EQ(object.extent[1], 0.2);
  EXPECT_EQ(object.place, "table");
  EXPECT_EQ(object.last_seen, at_second(0));
  ASSERT_EQ(object.num_attributes, 2);
  EXPECT_EQ(object.attributes[0].name, "color");
  EXPECT_EQ(object.attributes[0].kind, attribute_t::SYMBOLS);
  ASSERT_EQ(object.attributes[0].num_symbols, 3);
  EXPECT_EQ(object.attributes[0].symbols[0], "red");
  EXPECT_NEAR(object.attributes[0].probabilities[0], 0.8, 1e-12);
  EXPECT_EQ(object.attributes[1].kind, attribute_t::SCALAR);
  EXPECT_EQ(object.attributes[1].mean, 0.12);
  EXPECT_EQ(object.attributes[1].variance, 0.0004);
  EXPECT_FALSE(message.objects[1].has_yaw);
  EXPECT_EQ(message.objects[1].place, "hall");
}

TEST(WorldMessage, OfAnEmptyWorld) {
  const World world(small_world());
  const auto bytes = encode_world(*world.belief(), *world.background(), 1);
  world_t message{};
  ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  EXPECT_EQ(message.num_objects, 0);
  EXPECT_EQ(message.expected_count, 0);
}

}  // namespace
}  // namespace anchord
