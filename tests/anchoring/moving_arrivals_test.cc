#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kClutter = 1e-3, kDetected = 0.9;

/// People that come through the door of an apartment at (1, 1) and walk on; `more` is put into the
/// arrivals' entry.
World house(const std::string& more, const std::string& limits = std::string(kExact)) {
  const auto with = [&](const std::string& classes) {
    auto knowledge =
        small_world(R"({"classes": {"default": {"undetected_intensity": 0, "models": [
        {"kind": "constant_velocity", "acceleration_psd": 0.1, "initial_velocity_variance": 1}],
        )" + classes +
                    R"(}}, "attributes": {"class": {"kind": "categorical", "symbols": ["cup"]}}})");
    if (!limits.empty()) knowledge.limits = small_world(limits).limits;
    return World(std::move(knowledge));
  };
  return with(R"("arrivals": [{"mean": [1, 1], "covariance": [0.04, 0, 0, 0.04], )" + more + "}]");
}

double unseen(const World& world, double second, int place = -1) {
  return undetected(*world.belief(), at_second(second), {}, place, *world.background());
}

TEST(MovingArrivals, ADetectionUpdatesWhatWasExpectedThere) {
  World world = house(R"("rate": 0, "moves": true, "at_start": 0.2, "velocity": [0.5, 0])");
  // Nothing of it may be looked at before: an empty look takes its share.
  apply(world, {blink(0), frame(2, {at(2.2, 1.1, 0.01)})});
  // One axis at a time: position and velocity, covariance, 2 s on.
  Eigen::Matrix2d f, q, p = Eigen::Vector2d(0.04, 1).asDiagonal();
  f << 1, 2, 0, 1;
  q << 8 / 3.0, 2, 2, 2;
  p = (f * p * f.transpose() + 0.1 * q).eval();
  const double s = p(0, 0) + 0.01;
  const Eigen::Vector2d gain = p.col(0) / s;
  const double e =
      kDetected * 0.2 * std::exp(-0.5 * (0.2 * 0.2 + 0.1 * 0.1) / s) / (2 * std::numbers::pi * s);
  const auto found = objects(world);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].p, e / (kClutter + e), kRounding);
  const Kinematic& k = position_of(found[0].versions[0].leaf);
  EXPECT_NEAR(k.position.x(), 2 + gain[0] * 0.2, kRounding);
  EXPECT_NEAR(k.velocity.x(), 0.5 + gain[1] * 0.2, kRounding);
  EXPECT_NEAR(k.velocity.y(), gain[1] * 0.1, kRounding);
  EXPECT_NEAR(k.pp(0, 0), p(0, 0) - gain[0] * p(0, 0), kRounding);
  EXPECT_NEAR(k.vv(1, 1), p(1, 1) - gain[1] * p(0, 1), kRounding);
}

TEST(MovingArrivals, WhoIsFirstSeenFarFromTheDoorIsBelieved) {
  // It came at 0 s with 1 m/s and was missed until it was 3 m away.
  for (const bool moves : {false, true}) {
    World world = house(moves ? R"("rate": 0.1, "moves": true)" : R"("rate": 0.1)");
    apply(world, {blink(0), blink(2), frame(3, {at(4, 1, 0.01)})});
    const auto found = objects(world);
    const double p = found.empty() ? 0 : found[0].p;
    if (moves)
      EXPECT_GT(p, 0.5);
    else
      EXPECT_LT(p, 0.01);
  }
}

TEST(MovingArrivals, TwoFramesOfOneInstantLookTwice) {
  World world = house(R"("rate": 0.3, "moves": true, "velocity_covariance": [0.01, 0, 0, 0.01])");
  apply(world, {blink(0), frame(0.1, {}, "left"), frame(0.1, {}, "right")});
  // The bounds are 5 standard deviations away.
  EXPECT_NEAR(unseen(world, 0.1), 0.03 * (1 - kDetected) * (1 - kDetected), 1e-9);
}

TEST(MovingArrivals, TheUnseenAreExpectedOnceAndWhereTheyMayBe) {
  World world = house(R"("rate": 0.3, "moves": true, "at_start": 0.1, "velocity": [1, 0],
                         "velocity_covariance": [0.01, 0, 0, 0.01])");
  apply(world, {blink(0)});
  EXPECT_NEAR(unseen(world, 0), 0.1, 1e-6);  // bounds: 5 sigma
  const auto& knowledge = world.background()->knowledge;
  const int kitchen = knowledge.find_place("kitchen"), hall = knowledge.find_place("hall");
  EXPECT_NEAR(unseen(world, 0, kitchen), 0.1, 1e-6);
  EXPECT_NEAR(unseen(world, 1), 0.1 + 0.3, 2e-3);  // a few walk off through a wall
  // Who was there at first is in the hall 2.5 s later, nearly for certain.
  EXPECT_GT(unseen(world, 2.5, hall), 0.05);
  EXPECT_NEAR(unseen(world, 2.5, hall) + unseen(world, 2.5, kitchen), unseen(world, 2.5), 1e-9);
}

TEST(MovingArrivals, AFrameThatSeesNothingChangesNothing) {
  World often = house(R"("rate": 0.3, "moves": true)"), once = often;
  apply(often, {blink(0), blink(1), blink(1.5), frame(3, {at(1.5, 1.2)})});
  apply(once, {blink(0), frame(3, {at(1.5, 1.2)})});
  EXPECT_EQ(objects(often)[0].p, objects(once)[0].p);
}

TEST(MovingArrivals, LateFramesArePutInTheirPlace) {
  const std::vector<Frame> frames{frame(0, {}, "left"), frame(1, {at(1.3, 1)}, "left"),
                                  frame(1.2, {at(1.4, 1)}, "right"), frame(1.4, {}, "left")};
  World in_order = house(R"("rate": 0.3, "moves": true)"), late = in_order;
  apply(in_order, frames);
  apply(late, {frames[0], frames[1], frames[3], frames[2]});
  EXPECT_EQ(everything(late), everything(in_order));
}

TEST(MovingArrivals, OtherClassesKeepTheirs) {
  World world(small_world(R"({"classes": {"box": {"arrivals": [{"mean": [1, 1], "rate": 0.5,
      "covariance": [0.04, 0, 0, 0.04], "moves": true}]}}})"));
  apply(world, {blink(0), frame(1, {at(1, 1, "class", "cup", 1), at(1.2, 1, "class", "box", 1)})});
  for (const auto& object : objects(world)) {
    const Leaf& leaf = object.versions[0].leaf;
    const bool box = leaf.top_class() == 1;
    // Of the cup: 0.01 per m^2 at rest, and its own covariance; of the box, less.
    EXPECT_EQ(position_of(leaf).pp(0, 0) < 1e-4, box);
    EXPECT_EQ(object.p > 0.99, box);
  }
}

}  // namespace
}  // namespace anchord
