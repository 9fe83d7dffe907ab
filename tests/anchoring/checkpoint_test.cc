// A world that goes on from a checkpoint believes what it would have believed.

#include "anchoring/checkpoint.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_events.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

std::vector<std::uint8_t> bytes_of(const World& world) {
  return write_checkpoint(world.state(), *world.background());
}

void apply(World& world, const Accepted& accepted) {
  if (const auto* frame = std::get_if<Frame>(&accepted.what))
    ASSERT_TRUE(world.apply(*frame, accepted.work).ok());
  else
    ASSERT_TRUE(world.apply(std::get<Event>(accepted.what)).ok());
}

/// Another world that has read what this one has written; `log` is all that it took.
World reopened(const World& world, const std::vector<Accepted>& log) {
  World other(world.background()->knowledge);
  auto state = read_checkpoint(bytes_of(world), other);
  EXPECT_TRUE(state.ok());
  std::vector<Accepted> recent;
  for (const WorldState::Step& step : state->recent) recent.push_back(log[step.number - 1]);
  EXPECT_TRUE(other.resume(*std::move(state), recent).ok());
  return other;
}

/// Closes and reopens one world before each step, never the other: they stay equal, to the bit.
void expect_no_difference(const Knowledge& knowledge, const std::vector<Accepted>& log) {
  World all(knowledge), parts(knowledge);
  for (std::size_t i = 0; i < log.size(); ++i) {
    parts = reopened(parts, {log.begin(), log.begin() + static_cast<std::ptrdiff_t>(i)});
    apply(all, log[i]);
    apply(parts, log[i]);
    ASSERT_EQ(everything(parts), everything(all)) << "step " << i;
    ASSERT_EQ(bytes_of(parts), bytes_of(all)) << "step " << i;
    EXPECT_EQ(parts.late_frames(), all.late_frames());
  }
}

TEST(Checkpoint, RandomScenesWithAndWithoutLimits) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    std::mt19937_64 random(seed);
    const auto variety = enumeration::random_variety(random);
    auto scene = enumeration::random_scene(random, variety);
    std::vector<Accepted> log;
    for (const std::size_t i : scene.arrival) log.push_back({scene.frames[i]});
    for (const Limits& limits : {scene.knowledge.limits, Limits{}}) {
      SCOPED_TRACE(seed);
      scene.knowledge.limits = limits;
      expect_no_difference(scene.knowledge, log);
    }
  }
}

TEST(Checkpoint, EventsAndWhatTheyPutAside) {
  const std::vector<Accepted> log{
      {frame(0, {at(1, 1), at(2, 1)})},
      {frame(1, {at(1, 1), at(2, 1)})},
      {named(1.1, "cup-1", "mine")},
      {joined(1.2, "cup-1", "cup-2")},
      {frame(2, {at(1, 1)})},
      {undone(2.1, 4)},
      {event(Event::Kind::kGrasped, 2.2, "cup-1")},
      {frame(1.9, {at(2, 1)}, "late")},
      {frame(3, {at(2, 1)})},
  };
  expect_no_difference(small_world(), log);
}

TEST(Checkpoint, ABoundOnTheWorkComesBack) {
  std::vector<Accepted> log;
  for (int i = 0; i < 6; ++i)
    log.push_back({frame(0.1 * i, {at(1, 1), at(1.01, 1), at(1.02, 1.01)}), 20});
  expect_no_difference(small_world(), log);
}

TEST(Checkpoint, OfAnotherConfigurationOrCutShortIsRefused) {
  World world(small_world());
  ASSERT_TRUE(world.apply(frame(0, {at(1, 1)})).ok());
  auto bytes = bytes_of(world);
  const World other(small_world(R"({"world": {"cell": 0.5}})"));
  const auto read = read_checkpoint(bytes, other);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().field, "checkpoint");
  for (std::size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_FALSE(
        read_checkpoint({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)},
                        World(small_world()))
            .ok());
}

}  // namespace
}  // namespace anchord
