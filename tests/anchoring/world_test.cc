// What one world believes after a few frames, against numbers by hand.

#include "anchoring/world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

/// A few dozen operations on numbers near 1.
constexpr double kRounding = 1e-12;
/// small_world(): p_D, lambda of both classes together, kappa.
constexpr double kDetected = 0.9, kUnseen = 0.02, kClutter = 1e-3;

/// Merged into small_world(): the engine is exact.
Knowledge exact(const std::string& more = "{}") {
  Knowledge knowledge = small_world(more);
  knowledge.limits = small_world(kExact).limits;
  return knowledge;
}

double first_existence(double clutter) {
  return kDetected * kUnseen / (clutter + kDetected * kUnseen);
}

double after_miss(double r, double q) { return r * (1 - q) / (1 - r * q); }

TEST(World, AFirstDetectionIsNewOrClutter) {
  World world(exact());
  apply(world, {frame(0, {at(1, 1)})});
  ASSERT_EQ(objects(world).size(), 1u);
  EXPECT_NEAR(objects(world)[0].p, first_existence(kClutter), kRounding);
  EXPECT_EQ(objects(world)[0].last_seen(), at_second(0));
}

TEST(World, TheScoreIsTheOddsOfClutter) {
  for (const auto& [score, odds] : {std::pair{0.5, 1.0},
                                    {0.8, 0.25},
                                    {0.2, 4.0},
                                    {1.0, 1e-6 / (1 - 1e-6)},
                                    {0.0, (1 - 1e-6) / 1e-6}}) {
    World world(exact());
    Detection z = at(1, 1);
    z.score = score;
    apply(world, {frame(0, {z})});
    EXPECT_NEAR(objects(world)[0].p, first_existence(kClutter * odds), kRounding) << score;
  }
}

TEST(World, ScoresCountAsTheSensorsCalibrationHasThem) {
  Knowledge knowledge = exact();
  knowledge.default_sensor.score_calibration.rest = {-0.5, 0.8};
  World world(knowledge);
  Detection z = at(1, 1);
  z.score = 0.8;  // odds against: 1/4
  apply(world, {frame(0, {z})});
  const double odds = std::exp(0.5 - 0.8 * std::log(4));
  EXPECT_NEAR(objects(world)[0].p, first_existence(kClutter * odds), kRounding);
}

TEST(World, ScoresCountByDistanceAndLabel) {
  Knowledge knowledge = exact();
  knowledge.default_sensor.score_calibration = {{0, 1, 0}, {{-0.5, 0.8, 0.1}, {0, 1, 0}}};
  World world(knowledge);
  Detection z = at(3, 4);  // 5 m away
  z.score = 0.8;
  z.attributes.push_back({"class", SymbolReport{{{"cup", 0.6}, {"box", 0.4}}}});
  Frame looked = frame(0, {z});
  looked.pose.emplace();
  apply(world, {looked});
  const double odds = std::exp(0.5 - 0.8 * std::log(4) - 0.1 * 5);
  EXPECT_NEAR(objects(world)[0].p, first_existence(kClutter * odds), kRounding);
}

TEST(World, MissesLowerExistence) {
  World world(exact());
  apply(world, {frame(0, {at(1, 1)})});
  double r = first_existence(kClutter);
  for (int second = 1; second < 5; ++second) {
    apply(world, {frame(second, {})});
    r = after_miss(r, kDetected);
    EXPECT_NEAR(objects(world)[0].p, r, kRounding);
  }
  EXPECT_EQ(objects(world)[0].last_seen(), at_second(0));
}

TEST(World, AnUndetectableTwinKeepsExistenceThroughMisses) {
  const double hides = 0.2, returns = 0.1;
  World world(exact(R"({"classes": {"default": {
      "models": [{"kind": "constant_position", "position_psd": 0},
                 {"kind": "constant_position", "position_psd": 0, "detectable": false}],
      "transitions": [{"from": 0, "to": 1, "rate": 0.2}, {"from": 1, "to": 0, "rate": 0.1}]}}})"));
  apply(world, {frame(0, {at(1, 1)})});
  double r = first_existence(kClutter), alone = r, w = 1;
  for (int second = 1; second <= 20; ++second) {
    apply(world, {frame(second, {})});
    // dw/dt = returns (1 - w) - hides w, over a second.
    const double rest = returns / (hides + returns);
    w = rest + (w - rest) * std::exp(-(hides + returns));
    r = after_miss(r, kDetected * w);
    w *= (1 - kDetected) / (1 - kDetected * w);
    alone = after_miss(alone, kDetected);
    EXPECT_NEAR(objects(world)[0].p, r, 1e-11) << "the chain goes through a matrix exponential";
    EXPECT_NEAR(objects(world)[0].versions[0].leaf.models[0].weight, w, 1e-11);
  }
  EXPECT_GT(r, 0.1);
  EXPECT_LT(alone, 1e-15);
}

TEST(World, ObjectsDepart) {
  World world(exact(R"({"classes": {"default": {"departure_rate": 0.01}}})"));
  apply(world, {frame(0, {at(1, 1)}), blink(60)});
  EXPECT_NEAR(objects(world)[0].p, first_existence(kClutter) * std::exp(-0.6), kRounding);
}

TEST(World, WhatDepartsSoonerIsLessLikelyThere) {
  World world(exact(R"({"classes": {"cup": {"departure_rate": 0.1}}})"));
  apply(world, {frame(0, {at(1, 1)}), blink(10)});
  const double stays = (1 + std::exp(-1)) / 2;
  EXPECT_NEAR(objects(world)[0].p, first_existence(kClutter) * stays, kRounding);
  EXPECT_NEAR(objects(world)[0].classes(*world.background())[0], std::exp(-1) / 2 / stays,
              kRounding);
}

TEST(World, AnHourUnseenItIsSomewhereInItsPlace) {
  for (const auto& [place, kitchen, table] :
       {std::tuple{"table", 1.0, 1.0}, {"kitchen", 1.0, 1.0 / 12}, {"hall", 0.0, 0.0}}) {
    World world(small_world(R"({"classes": {"default": {"models": [
        {"kind": "constant_position", "position_psd": 0},
        {"kind": "somewhere", "place": ")" +
                            std::string(place) + R"(", "rate": 0.001}]}}})"));
    apply(world, {frame(0, {at(4, 1)}), blink(3600)});
    const double left = 1 - std::exp(-3.6);  // the rest is still where it was, in the hall
    const ObjectBelief object = objects(world)[0];
    const Background& background = *world.background();
    const auto in = [&](const char* name) {
      return object.in_place(background.knowledge.find_place(name), background);
    };
    EXPECT_NEAR(in("kitchen"), left * kitchen, 1e-9);
    EXPECT_NEAR(in("table"), left * table, 1e-9);
    EXPECT_NEAR(in("hall"), 1 - left * kitchen, 1e-9);
    EXPECT_NEAR(object.outside_places(background), 0, 1e-9);
    EXPECT_EQ(object.last_seen(), at_second(0));
  }
}

TEST(World, ASensorsNoiseAndViewHoldWhereAFrameHasNone) {
  const auto more = R"({"sensors": {"default": {"view": {"type": "world"}},
      "camera": {"noise": {"covariance": [0.04, 0, 0, 0.01], "polar": [0.04, 0.0001, 0.0001]},
                 "view": {"type": "polygon", "points": [[0, 0], [2, 0], [2, 4], [0, 4]]}}}})";
  Detection bare = at(1, 1);
  std::get<CartesianMeasurement>(bare.measurement).covariance.clear();
  World world(exact(more));
  apply(world, {frame(0, {bare, at(4, 1)}, "camera")});
  const auto believed = objects(world);
  const Eigen::Matrix3d given = believed[0].moments(*world.background()).covariance;
  EXPECT_NEAR(given(0, 0), 0.04, kRounding);
  EXPECT_NEAR(given(1, 1), 0.01, kRounding);
  const Eigen::Matrix3d own = believed[1].moments(*world.background()).covariance;
  EXPECT_NEAR(own(0, 0), 1e-4, kRounding) << "a detection's own covariance goes before";

  apply(world, {frame(1, {}, "camera")});
  EXPECT_LT(objects(world)[0].p, believed[0].p) << "in the configured view";
  EXPECT_NEAR(objects(world)[1].p, believed[1].p, kRounding) << "outside of it";
  Frame everywhere = frame(2, {}, "camera");
  everywhere.view = View{};
  everywhere.view->type = View::Type::kWorld;
  apply(world, {everywhere});
  EXPECT_LT(objects(world)[1].p, believed[1].p) << "a frame's own view goes before";

  Frame polar = frame(3, {}, "camera");
  polar.detections.resize(1);
  polar.detections[0].measurement = PolarMeasurement{2, 0, 0, {}};
  EXPECT_TRUE(world.apply(polar).ok());
}

/// P(z is the first object's) over P(it is not), after a second detection that names `object`.
double odds(const std::string& object) {
  World world(exact(R"({"sensors": {"default": {"identity_doubt": 0.05}}})"));
  apply(world, {frame(0, {at(1, 1)})});
  Detection z = at(1.03, 1);
  z.object = object;
  apply(world, {frame(1, {z})});
  const auto believed = objects(world);
  EXPECT_EQ(believed.size(), 2u);
  // Where z is its own object's, the first was given it: it was seen last now.
  double given = 0;
  for (const auto& version : believed[0].versions)
    if (version.leaf.last_seen == at_second(1)) given += version.probability;
  return given / (1 - given);
}

TEST(World, IdentityDoubtWeighsWhatIsNotTheNamedObject) {
  const double unnamed = odds("");
  EXPECT_NEAR(odds("object-1") / unnamed, 1, 1e-9) << "an unknown name doubts all alike";
  EXPECT_NEAR(odds("cup-1") / unnamed, 1 / 0.05, 1e-6) << "weights of 1e-6 and less, normalised";
}

TEST(World, NoUpdateAveragesBelowThePoseFloor) {
  World world(small_world(R"({"sensors": {"default": {"pose_floor": 0.0025}}})"));
  World without(small_world());
  for (int i = 0; i < 50; ++i) {
    for (World* w : {&world, &without}) apply(*w, {frame(0.1 * i, {at(1, 1, 0.01)})});
    const Eigen::Matrix3d c = objects(world)[0].moments(*world.background()).covariance;
    EXPECT_GE(c(0, 0), 0.0025 - kRounding);
    EXPECT_GE(c(1, 1), 0.0025 - kRounding);
  }
  EXPECT_LT(objects(without)[0].moments(*without.background()).covariance(0, 0), 0.001);
}

TEST(World, YawIsCarriedThroughInTheMap) {
  World world(small_world());
  Detection z = at(1, 0);
  z.yaw = 0.5;
  Frame f = frame(0, {z});
  f.pose = Pose{{1, 1, 0}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, {}};  // a quarter turn left
  apply(world, {f, frame(1, {})});
  const Leaf leaf = objects(world)[0].versions[0].leaf;
  ASSERT_TRUE(leaf.yaw);
  EXPECT_NEAR(*leaf.yaw, 0.5 + std::acos(0.0), kRounding);
  const Gaussian where = objects(world)[0].moments(*world.background());
  EXPECT_NEAR(where.mean.x(), 1, 1e-9) << "one metre ahead of the sensor, which looks along y";
  EXPECT_NEAR(where.mean.y(), 2, 1e-9);
}

TEST(World, EqualFramesGiveEqualBeliefs) {
  const auto fold = [] {
    World world(small_world());
    for (int i = 0; i < 20; ++i)
      apply(world, {frame(0.1 * i, {at(1 + 0.01 * i, 1, 0.01), at(1.2, 1, 0.01), at(4, 2)})});
    return everything(world);
  };
  EXPECT_EQ(fold(), fold());
}

TEST(World, ACopyIsAWorldOfItsOwn) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1)})});
  const std::string before = everything(world);
  World copy = world;
  apply(copy, {frame(1, {at(1, 1), at(4, 1)})});
  EXPECT_EQ(everything(world), before);
  EXPECT_NE(everything(copy), before);
}

}  // namespace
}  // namespace anchord
