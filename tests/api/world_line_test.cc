#include "api/world_line.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

World two_cups() {
  World world(small_world(R"({"classes": {"default": {"models": [
      {"kind": "constant_velocity"}, {"kind": "somewhere", "place": "kitchen", "rate": 0.1}]},
      "cup": {"extent": [0.1, 0.1, 0.12]}}})"));
  Detection doubtful = at(4, 2);
  doubtful.score = 0.01;
  Detection turned = at(1, 1, "class", "cup", 0.9);
  turned.yaw = 0.25;
  apply(world, {frame(0, {turned, at(2, 1, "class", "cup", 0.8), doubtful}), blink(1)});
  return world;
}

Json line_of(const World& world, const WorldLineOptions& options = {}) {
  return world_line(*world.belief(), *world.background(), options);
}

std::set<std::string> keys(const Json& object) {
  std::set<std::string> out;
  for (const auto& [key, value] : object.items()) out.insert(key);
  return out;
}

TEST(WorldLine, HasTheFieldsOfTheBestWorld) {
  const World world = two_cups();
  const Json line = line_of(world);
  EXPECT_EQ(keys(line), (std::set<std::string>{"utime", "objects", "expected_count", "hypotheses",
                                               "clusters"}));
  EXPECT_EQ(line["utime"], at_second(1));
  ASSERT_EQ(line["objects"].size(), 2u) << "the third does not stand in the best world";
  const Json& cup = line["objects"][0];
  EXPECT_EQ(keys(cup),
            (std::set<std::string>{"id", "p", "position", "covariance", "velocity", "attributes",
                                   "models", "last_seen", "yaw", "extent"}));
  EXPECT_EQ(cup["id"], "cup-1");
  EXPECT_EQ(cup["position"].size(), 2u);
  EXPECT_EQ(cup["covariance"].size(), 4u);
  EXPECT_EQ(cup["velocity"].size(), 2u);
  EXPECT_EQ(cup["last_seen"], at_second(0));
  EXPECT_NEAR(cup["attributes"]["class"]["cup"].get<double>(), 0.9, 1e-12);
  // exp(-0.1) after a second.
  EXPECT_NEAR(cup["models"]["constant_velocity"].get<double>(), 0.904837418035960, 1e-12);
  EXPECT_NEAR(cup["models"]["somewhere"].get<double>(), 0.095162581964040, 1e-12);
  EXPECT_EQ(cup["yaw"], 0.25);
  EXPECT_EQ(cup["extent"], Json::parse("[0.1, 0.1, 0.12]"));
  EXPECT_EQ(keys(line["objects"][1]).count("yaw"), 0u);
}

TEST(WorldLine, ExpectedCountIsTheSumOverAll) {
  const World world = two_cups();
  double sum = 0;
  for (const auto& object : objects(world)) sum += object.p;
  EXPECT_EQ(objects(world).size(), 3u);
  EXPECT_EQ(line_of(world)["expected_count"], sum);
}

TEST(WorldLine, AllAddsWhatStandsInNoBestWorldAndMarginals) {
  const Json line = line_of(two_cups(), {.all = true, .elapsed_us = {}});
  ASSERT_EQ(line["objects"].size(), 3u);
  EXPECT_EQ(line["objects"][0]["in_best"], true);
  EXPECT_EQ(line["objects"][2]["in_best"], false);
  EXPECT_EQ(line["objects"][2]["id"], "new-3");
  const Json& marginal = line["objects"][0]["marginal"];
  EXPECT_EQ(marginal["position"].size(), 2u);
  EXPECT_EQ(marginal["covariance"].size(), 4u);
  // A tenth of the mass is anywhere in the kitchen, 3 x 4 m.
  EXPECT_GT(marginal["covariance"][3].get<double>(), 0.1 * 16 / 12 * 0.9);
}

TEST(WorldLine, HypothesesAreThoseOfEachCluster) {
  const World world = two_cups();
  for (const int limit : {1, 100}) {
    const Json line = line_of(world, {.hypotheses = limit, .elapsed_us = {}});
    ASSERT_EQ(line["cluster_hypotheses"].size(), line["clusters"].get<std::size_t>());
    for (const Json& cluster : line["cluster_hypotheses"]) {
      EXPECT_LE(cluster.size(), static_cast<std::size_t>(limit));
      double sum = 0;
      for (const Json& h : cluster) {
        sum += h["p"].get<double>();
        for (const Json& member : h["members"]) EXPECT_TRUE(member["id"].is_string());
      }
      EXPECT_LE(sum, 1 + 1e-12);
      if (limit == 100) {
        EXPECT_NEAR(sum, 1, 1e-12);
      }
    }
  }
}

TEST(WorldLine, TimeIsLeftOutUnlessGiven) {
  const World world = two_cups();
  EXPECT_EQ(keys(line_of(world)).count("elapsed_us"), 0u);
  EXPECT_EQ(line_of(world, {.elapsed_us = 310.04})["elapsed_us"], 310.0);
}

TEST(WorldLine, BeforeTheFirstFrameThereIsNothing) {
  const Json line = line_of(World(small_world()));
  EXPECT_TRUE(line["objects"].empty());
  EXPECT_EQ(line["expected_count"], 0);
  EXPECT_EQ(line["hypotheses"], 0);
}

}  // namespace
}  // namespace anchord
