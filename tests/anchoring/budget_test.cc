// A bound on the work of a frame, and what pruning says that it dropped.

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/anchoring/dice.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Five like objects within each other's gates, in two places, some missed, with clutter: by two
/// sensors in turn.
std::vector<Frame> crowd(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Dice dice(random);
  std::vector<Frame> frames;
  for (int step = 0; step < 12; ++step) {
    const auto detections = rows(dice, 10, 5, 3, 0.1, 0.5);
    frames.push_back(frame(0.1 * step, detections, step % 2 ? "left" : "right"));
  }
  return frames;
}

std::string folded(const std::vector<Frame>& frames, std::optional<std::uint64_t> work,
                   std::vector<Effort>& efforts) {
  World world(small_world());
  for (const Frame& frame : frames) {
    EXPECT_TRUE(world.apply(frame, work).ok());
    efforts.push_back(world.belief()->effort);
  }
  return everything(world);
}

TEST(Budget, IsKept) {
  const auto frames = crowd(1);
  std::vector<Effort> free;
  const std::string unbounded = folded(frames, std::nullopt, free);
  std::uint64_t most = 0;
  for (const Effort& effort : free) {
    EXPECT_FALSE(effort.cut);
    most = std::max(most, effort.work);
  }
  ASSERT_GT(most, 4000u) << "the scene must be work";
  for (const std::uint64_t bound : {600, 1000, 2000}) {
    std::vector<Effort> bounded;
    EXPECT_NE(folded(frames, bound, bounded), unbounded);
    int cut = 0;
    for (const Effort& effort : bounded) {
      EXPECT_LE(effort.work, bound);
      cut += effort.cut ? 1 : 0;
      if (effort.cut) {
        EXPECT_GT(effort.dropped, 0);
      }
    }
    EXPECT_GT(cut, 0) << bound;
  }
  // The least there is: one hypothesis of each cluster, and one after it.
  std::vector<Effort> least;
  folded(frames, 0, least);
  for (const Effort& effort : least) EXPECT_LT(effort.work, 100u);
}

TEST(Budget, ThatIsNotReachedChangesNothing) {
  const auto frames = crowd(2);
  std::vector<Effort> free, bounded;
  const std::string unbounded = folded(frames, std::nullopt, free);
  EXPECT_EQ(folded(frames, 10'000'000, bounded), unbounded);
  for (std::size_t i = 0; i < free.size(); ++i) {
    EXPECT_FALSE(bounded[i].cut);
    EXPECT_EQ(bounded[i].work, free[i].work);
    EXPECT_EQ(bounded[i].dropped, free[i].dropped);
  }
}

/// Each frame keeps its bound when a late one makes it be folded again.
TEST(Budget, HoldsForAFrameWhereverItArrives) {
  const auto frames = crowd(3);
  const auto arrive = [&](const std::vector<std::size_t>& order) {
    World world(small_world());
    for (const std::size_t i : order) EXPECT_TRUE(world.apply(frames[i], 500 + 100 * i).ok());
    EXPECT_GT(world.belief()->cut_frames, 0u);
    return everything(world);
  };
  EXPECT_EQ(arrive({0, 1, 2, 3, 4, 5, 6, 7}), arrive({0, 2, 1, 4, 3, 6, 5, 7}));
}

/// Two frames: before the second there is one hypothesis, so that what it drops is all that is
/// lost.
TEST(Dropped, BoundsWhatAnyProbabilityLost) {
  int lossy = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    enumeration::Variety variety = enumeration::random_variety(random);
    variety.verification = false;
    auto scene = enumeration::random_scene(random, variety);
    scene.frames.resize(std::min<std::size_t>(scene.frames.size(), 2));
    World exact(scene.knowledge);
    scene.knowledge.limits.max_hypotheses = 2;
    World limited(scene.knowledge);
    anchord::apply(exact, scene.frames);
    anchord::apply(limited, scene.frames);
    EXPECT_EQ(exact.belief()->dropped, 0) << "seed " << seed;
    std::map<std::uint64_t, double> p;
    for (const auto& object : objects(limited)) p[object.anchor->birth] = object.p;
    for (const auto& object : objects(exact)) {
      const double lost = std::abs(object.p - p[object.anchor->birth]);
      EXPECT_LE(lost, limited.belief()->dropped + 1e-9) << "seed " << seed;
      lossy += lost > 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(lossy, 20) << "the scenes must lose something";
}

}  // namespace
}  // namespace anchord
