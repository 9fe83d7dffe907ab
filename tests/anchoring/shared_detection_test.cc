// Objects that touch and are detected as one, and one object that is detected twice.

#include "anchoring/shared_detection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

/// Things pushed about that are detected as one within about 0.1 m. Nothing new comes: what is
/// there is there at first.
Knowledge pushed(const char* more = "{}") {
  Knowledge knowledge = small_world(more);
  for (ObjectClass& c : knowledge.classes) {
    c.departure_rate = 0.01;
    c.models.resize(1);
    c.models[0].kind = BehaviourModel::Kind::kConstantVelocity;
    c.models[0].psd = 0.02;
    c.models[0].initial_velocity_variance = 0.01;
    c.models[0].initial_weight = 1;
    BehaviourModel sharing = c.models[0];
    sharing.initial_weight = 0;
    sharing.kind = BehaviourModel::Kind::kConstantPosition;
    sharing.psd = 0.002;
    sharing.stir = 0.2;
    sharing.shared_probability = 0.99;
    sharing.reach = 0.05;
    c.models.push_back(sharing);
    c.transitions = {{0, 1, 0.5}, {1, 0, 0.2}};
  }
  return knowledge;
}

double expected_count(const World& world) {
  double sum = 0;
  for (const ObjectBelief& object : objects(world)) sum += object.p;
  return sum;
}

double existence(const World& world, const std::string& id) {
  for (const ObjectBelief& object : objects(world))
    if (object.anchor->id() == id) return object.p;
  return 0;
}

/// Two boxes that go towards each other, 10 Hz; from `meets` on they touch, and are one detection
/// in their middle, until they part again.
std::vector<Frame> meeting(double meets, double parts, double end) {
  std::vector<Frame> frames;
  for (int i = 0; i <= std::lround(10 * end); ++i) {
    const double t = 0.1 * i;
    const double apart = t < meets ? meets - t : t > parts ? t - parts : 0;  // at 0.2 m/s each
    const double half = 0.05 + 0.2 * apart;
    if (apart > 0)
      frames.push_back(frame(t, {at(3 - half, 2), at(3 + half, 2)}));
    else
      frames.push_back(frame(t, {at(3, 2)}));
  }
  return frames;
}

TEST(SharedDetection, TwoThatTouchForSecondsStayTwo) {
  for (const double seconds : {1.0, 5.0, 20.0}) {
    World world(pushed());
    anchord::apply(world, meeting(2, 2 + seconds, 2 + seconds));
    EXPECT_NEAR(expected_count(world), 2, 0.05) << seconds;
    for (const ObjectBelief& object : objects(world))
      if (object.p > 0.5) {
        // Both are where the one detection is, within reach.
        const Gaussian moments = object.moments(*world.background());
        EXPECT_NEAR(moments.mean.x(), 3, 0.1);
        EXPECT_LT(std::sqrt(moments.covariance(0, 0)), 0.15);
      }
  }
}

TEST(SharedDetection, BothKeepTheirNamesWhenTheyPart) {
  World world(pushed());
  const auto frames = meeting(2, 4, 6);
  anchord::apply(world, std::vector<Frame>(frames.begin(), frames.begin() + 10));
  const auto before = ids(world);
  anchord::apply(world, std::vector<Frame>(frames.begin() + 10, frames.end()));
  double believed = 0;
  for (const std::string& id : before) believed += existence(world, id);
  EXPECT_NEAR(believed, 2, 0.05);
  EXPECT_NEAR(expected_count(world), 2, 0.05);
}

TEST(SharedDetection, WithoutItOneOfThemIsGone) {
  // What the test of two that stay two would not see if contact meant nothing.
  Knowledge knowledge = pushed();
  for (ObjectClass& c : knowledge.classes) c.models.resize(1), c.transitions.clear();
  World world(knowledge);
  anchord::apply(world, meeting(2, 7, 7));
  EXPECT_NEAR(expected_count(world), 1, 0.05);
}

TEST(SharedDetection, OneAloneStaysOne) {
  World world(pushed());
  for (int i = 0; i < 100; ++i) anchord::apply(world, {frame(0.1 * i, {at(1 + 0.01 * i, 2)})});
  EXPECT_NEAR(expected_count(world), 1, 0.01);
}

TEST(SharedDetection, OneThatGoesAwayFromTheOtherIsMissed) {
  // The sharing model does not make up for misses where nothing is near.
  World world(pushed());
  for (int i = 0; i < 20; ++i) anchord::apply(world, {frame(0.1 * i, {at(1, 2), at(4, 2)})});
  for (int i = 20; i < 40; ++i) anchord::apply(world, {frame(0.1 * i, {at(1, 2)})});
  EXPECT_NEAR(expected_count(world), 1, 0.02);
}

TEST(SharedDetection, WhatAJointDetectionSaysIsNotLearned) {
  World world(pushed());
  const auto sized = [](double x, double size) {
    Detection z = at(x, 2);
    z.attributes.push_back({"size", ScalarReport{size, 1e-4}});
    return z;
  };
  for (int i = 0; i <= 10; ++i) {
    const double half = 0.05 + 0.02 * (10 - i);
    anchord::apply(world, {frame(0.1 * i, {sized(3 - half, 0.1), sized(3 + half, 0.1)})});
  }
  for (int i = 11; i <= 40; ++i) anchord::apply(world, {frame(0.1 * i, {sized(3, 0.2)})});
  EXPECT_NEAR(expected_count(world), 2, 0.05);
  for (const ObjectBelief& object : objects(world)) {
    if (object.p < 0.5) continue;
    for (const auto& version : object.versions)
      for (const AttributeBelief& belief : version.leaf.attributes)
        if (belief.symbols.empty()) {
          EXPECT_NEAR(belief.mean, 0.1, 0.01);
        }
  }
}

/// What is expected after 20 frames of an object, of which every so many have a second detection.
double expected_of_doubled(double often, int every) {
  Knowledge knowledge = small_world();
  knowledge.default_sensor.double_detection = often;
  for (Sensor& sensor : knowledge.sensors) sensor.double_detection = often;
  World world(knowledge);
  for (int i = 0; i < 20; ++i) {
    std::vector<Detection> seen{at(1, 2)};
    if (i % every == 0) seen.push_back(at(1 + 0.01 * (i % 2), 2.01));
    anchord::apply(world, {frame(i, seen)});
  }
  return expected_count(world);
}

TEST(DoubleDetection, MakesNoSecondObject) {
  EXPECT_NEAR(expected_of_doubled(0.3, 3), 1, 0.01);
  EXPECT_NEAR(expected_of_doubled(0, 3), 2, 0.05);
}

/// A second object is found in nine of ten frames, an object twice in three of ten: the exact
/// posterior multiplies the odds by about eight with each frame, from 6e-4 after two.
TEST(DoubleDetection, WhatComesInEveryFrameIsAnObject) {
  EXPECT_NEAR(expected_of_doubled(0.3, 1), 2, 0.01);
}

TEST(DoubleDetection, TwoApartStayTwo) {
  Knowledge knowledge = small_world();
  knowledge.default_sensor.double_detection = 0.3;
  World world(knowledge);
  for (int i = 0; i < 20; ++i) anchord::apply(world, {frame(i, {at(1, 2), at(1.1, 2)})});
  EXPECT_NEAR(expected_count(world), 2, 0.02);
}

}  // namespace
}  // namespace anchord
