#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "anchoring/checkpoint.h"
#include "anchoring/reconfigure.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_events.h"
#include "tests/anchoring/small_world.h"

namespace anchord {

/// What the tests of a changed configuration ask.

inline constexpr double kRounding = 1e-12;

inline World changed(const World& world, const Knowledge& knowledge) {
  auto next = reconfigured(world, knowledge);
  if (!next) ADD_FAILURE() << next.error().text();
  return next ? *std::move(next) : World(knowledge);
}

/// The belief as bytes, whatever steps may still be folded again.
inline std::vector<std::uint8_t> bytes_of(const World& world) {
  WorldState state;
  state.before = world.belief();
  return write_checkpoint(state, *world.background());
}

/// By id: p, and what answers say of classes and attributes, by name.
inline std::map<std::string, std::map<std::string, double>> answers(const World& world) {
  const Knowledge& known = world.background()->knowledge;
  std::map<std::string, std::map<std::string, double>> out;
  for (const ObjectBelief& object : anchors_by_name(world)) {
    auto& said = out[object.anchor->id()];
    said["p"] = object.p;
    for (const auto& version : object.versions) {
      const double weight = version.probability * version.leaf.existence;
      for (std::size_t c = 0; c < known.classes.size(); ++c)
        said["class " + known.classes[c].name] += weight * version.leaf.classes[c];
      for (const AttributeBelief& belief : version.leaf.attributes) {
        const Attribute& attribute = known.attributes[belief.attribute];
        for (std::size_t s = 0; s < belief.symbols.size(); ++s)
          said[attribute.name + " " + attribute.symbols[s]] += weight * belief.symbols[s];
        said[attribute.name] += weight * belief.mean;
      }
      for (const ModelState& state : version.leaf.models)
        if (const auto* kinematic = std::get_if<Kinematic>(&state.density)) {
          said["x"] += weight * state.weight * kinematic->position.x();
          said["y"] += weight * state.weight * kinematic->position.y();
        } else {
          said["in places"] += weight * state.weight;
        }
    }
  }
  return out;
}

/// Equal where both say something; what only one of them has is 0.
inline void expect_same_answers(const World& a, const World& b, double tolerance = kRounding) {
  auto in_a = answers(a), in_b = answers(b);
  ASSERT_EQ(in_a.size(), in_b.size());
  for (const auto& [id, said] : in_a) {
    ASSERT_TRUE(in_b.count(id)) << id;
    for (const auto& [what, value] : said)
      EXPECT_NEAR(value, in_b[id][what], tolerance) << id << ' ' << what;
    for (const auto& [what, value] : in_b[id])
      EXPECT_NEAR(value, in_a[id][what], tolerance) << id << ' ' << what;
  }
}

inline double expected_unseen(const World& world, const std::string& name) {
  const Background& background = *world.background();
  const Belief& belief = *world.belief();
  const int c = background.knowledge.find_class(name);
  double sum = 0;
  for (int cell = 0; cell < background.grid.size(); ++cell)
    sum += belief.undetected[c].at(cell, belief.seconds(belief.utime)) * background.cell_volume();
  return sum;
}

inline void expect_refused(const World& world, const Knowledge& knowledge, const std::string& field,
                           const std::vector<std::string>& named) {
  const std::string before = everything(world);
  const auto next = reconfigured(world, knowledge);
  ASSERT_FALSE(next.ok()) << field;
  EXPECT_EQ(next.error().code, ErrorCode::kConflict);
  EXPECT_EQ(next.error().field, field);
  for (const std::string& name : named)
    EXPECT_NE(next.error().message.find(name), std::string::npos) << next.error().message;
  EXPECT_EQ(everything(world), before);
}

/// small_world() with other symbols of an attribute.
inline Knowledge with_symbols(const std::string& attribute, const std::string& symbols) {
  return small_world(R"({"attributes": {")" + attribute + R"(": {"symbols": )" + symbols + "}}}");
}

}  // namespace anchord
