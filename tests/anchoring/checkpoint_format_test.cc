// Checkpoints that older programs have written are read.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "anchoring/checkpoint.h"
#include "tests/anchoring/older_checkpoint.h"
#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

std::vector<std::uint8_t> bytes_in(const std::string& file) {
  std::ifstream stream(ANCHORD_SOURCE_DIR "/tests/data/" + file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::uint8_t> bytes_of(const World& world) {
  return write_checkpoint(world.state(), *world.background());
}

/// A world that goes on from a checkpoint of older_scene().
World resumed(const std::vector<std::uint8_t>& bytes, const OlderScene& scene) {
  World world(scene.knowledge);
  auto state = read_checkpoint(bytes, world);
  EXPECT_TRUE(state.ok()) << state.error().text();
  std::vector<Accepted> recent;
  for (const WorldState::Step& step : state->recent)
    recent.push_back(scene.before[step.number - 1]);
  EXPECT_TRUE(world.resume(*std::move(state), recent).ok());
  return world;
}

/// What two answers that say the same differ by at the most; by more than 1 if they do not.
double difference(const nlohmann::json& a, const nlohmann::json& b) {
  if (a.is_number_float() && b.is_number_float())
    return std::abs(a.get<double>() - b.get<double>());
  if (!a.is_structured() || a.type() != b.type() || a.size() != b.size()) return a == b ? 0 : 2;
  double most = 0;
  for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y) {
    const bool other_key = a.is_object() && x.key() != y.key();
    most = std::max(most, other_key ? 2 : difference(*x, *y));
  }
  return most;
}

/// The checkpoint was written by another program, whose sums may be rounded otherwise.
double difference(const World& a, const World& b) {
  return difference(nlohmann::json::parse(everything(a)), nlohmann::json::parse(everything(b)));
}

TEST(CheckpointFormat, OneIsReadAndGoesOnAsIfItHadNeverStopped) {
  constexpr double kRounding = 1e-9;
  const OlderScene scene = older_scene();
  World all(scene.knowledge);
  for (const Accepted& step : scene.before) take(all, step);
  World older = resumed(bytes_in("checkpoint_1.bin"), scene);
  EXPECT_GT(older.state().recent.size(), 1u);
  EXPECT_EQ(older.state().floor, 0);
  World newer = resumed(bytes_of(older), scene);
  for (const Accepted& step : scene.after) {
    ASSERT_LT(difference(older, all), kRounding);
    ASSERT_EQ(bytes_of(newer), bytes_of(older));
    for (World* world : {&all, &older, &newer}) take(*world, step);
  }
  EXPECT_LT(difference(older, all), kRounding);
  EXPECT_EQ(everything(newer), everything(older));
}

TEST(CheckpointFormat, OfAProgramToComeIsRefused) {
  const OlderScene scene = older_scene();
  World world(scene.knowledge);
  take(world, scene.before[0]);
  auto bytes = bytes_of(world);
  ++bytes[0];  // the format's version is the lowest byte; this machine is little-endian
  const auto read = read_checkpoint(bytes, World(scene.knowledge));
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message.find("newer"), std::string::npos) << read.error().message;
}

}  // namespace
}  // namespace anchord
