// Frames of several sensors that arrive late against each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/anchoring/dice.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

using enumeration::Dice;

std::string folded(const Knowledge& knowledge, const std::vector<Frame>& frames,
                   const std::vector<std::size_t>& order, std::uint64_t* late = nullptr) {
  World world(knowledge);
  for (const std::size_t i : order) apply(world, {frames[i]});
  if (late) *late += world.late_frames();
  return everything(world);
}

std::vector<std::size_t> in_order(std::size_t n) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

TEST(LateFrames, RandomScenesWithAndWithoutLimits) {
  std::uint64_t late = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    enumeration::Variety variety = enumeration::random_variety(random);
    variety.sensors = variety.late = true;
    variety.verification = false;
    auto scene = enumeration::random_scene(random, variety);
    for (const Limits& limits : {scene.knowledge.limits, Limits{}}) {
      scene.knowledge.limits = limits;
      EXPECT_EQ(folded(scene.knowledge, scene.frames, scene.arrival, &late),
                folded(scene.knowledge, scene.frames, in_order(scene.frames.size())))
          << "seed " << seed;
    }
  }
  EXPECT_GT(late, 50u) << "the scenes must have late frames";
}

/// Three sensors at 20 Hz over three objects and clutter; the delay of each frame is random.
TEST(LateFrames, AnyArrivalWithinTheLatenessIsTheSame) {
  std::uint64_t late = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    std::mt19937_64 random(seed);
    Dice dice(random);
    std::vector<Frame> frames;
    for (int step = 0; step < 20; ++step)
      for (const char* sensor : {"left", "right", "top"}) {
        if (dice.chance(0.3)) continue;
        std::vector<Detection> detections;
        for (int object = 0; object < 3; ++object)
          if (dice.chance(0.9))
            detections.push_back(
                at(1 + 0.3 * object + 0.05 * dice.normal(), 1 + 0.05 * dice.normal(), 0.0025));
        if (dice.chance(0.3)) detections.push_back(at(dice.uniform(0, 6), dice.uniform(0, 4)));
        // Some at one instant, in order of acceptance.
        frames.push_back(frame(step * 0.05 + (dice.chance(0.5) ? 0 : dice.uniform(0, 0.04)),
                               detections, sensor));
      }
    std::stable_sort(frames.begin(), frames.end(),
                     [](const Frame& a, const Frame& b) { return a.utime < b.utime; });
    std::vector<double> arrival;
    std::map<std::string, double> last;
    std::map<Utime, double> instant;
    for (const Frame& f : frames) {
      double when = static_cast<double>(f.utime) * 1e-6 + dice.uniform(0, 0.49);
      when = std::max({when, last[f.sensor] + 1e-6, instant[f.utime] + 1e-6});
      arrival.push_back(last[f.sensor] = instant[f.utime] = when);
    }
    auto order = in_order(frames.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return arrival[a] < arrival[b]; });
    const Knowledge knowledge = small_world(
        R"({"classes": {"default": {"models": [
             {"kind": "constant_velocity", "acceleration_psd": 0.1},
             {"kind": "somewhere", "place": "kitchen", "rate": 0.02}]}}})");
    EXPECT_EQ(folded(knowledge, frames, order, &late),
              folded(knowledge, frames, in_order(frames.size())))
        << "seed " << seed;
  }
  EXPECT_GT(late, 100u);
}

TEST(LateFrames, AFrameBeforeTheFirstIsTheFirst) {
  const std::vector<Frame> frames{frame(0, {at(1, 1)}, "left"), frame(0.2, {at(1, 1)}, "right")};
  EXPECT_EQ(folded(small_world(), frames, {1, 0}), folded(small_world(), frames, {0, 1}));
}

TEST(LateFrames, EqualTimesFoldInOrderOfAcceptance) {
  // What came first is the older anchor.
  World world(small_world());
  apply(world, {frame(0, {at(1, 1)}, "left"), frame(0, {at(4, 1)}, "right")});
  EXPECT_EQ(world.late_frames(), 0u);
  const auto found = objects(world);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].moments(*world.background()).mean.x(), 1, 1e-9);
}

TEST(LateFrames, AnOldBeliefIsNotTouched) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1)}, "left"), frame(0.3, {at(1, 1)}, "left")});
  const auto old = world.belief();
  const double p = old->clusters[0]->existence(0, *world.background());
  apply(world, {frame(0.1, {}, "right")});
  EXPECT_NE(world.belief(), old);
  EXPECT_EQ(old->clusters[0]->existence(0, *world.background()), p);
  EXPECT_EQ(old->frames, 2u);
  EXPECT_EQ(world.belief()->frames, 3u);
}

}  // namespace
}  // namespace anchord
