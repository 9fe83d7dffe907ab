// The engine, with nothing pruned, against an enumeration of every association that shares no code
// with it.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "anchoring/reading.h"
#include "anchoring/world.h"
#include "tests/anchoring/enumeration.h"
#include "tests/anchoring/random_scene.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

using enumeration::EnumeratedBelief;
using enumeration::ObjectKey;
using enumeration::Scene;

/// Both sides sum at most some ten thousand worlds, each a product of some ten factors.
constexpr double kTolerance = 1e-9;

/// The engine numbers anchors by frame and detection, in the order of utime.
std::map<std::uint64_t, ObjectKey> keys_by_birth(const std::vector<Frame>& frames) {
  std::map<std::uint64_t, ObjectKey> keys;
  std::uint64_t birth = 0;
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t d = 0; d < frames[f].detections.size(); ++d) keys[++birth] = {f, d};
  return keys;
}

/// The engine's id, at this moment, of the anchor that a frame names by its birth.
std::string current_id(const World& world, const std::string& reference,
                       const std::vector<Frame>& frames) {
  const auto wanted = enumeration::parse_reference(reference);
  for (const auto& object :
       read_objects(*world.belief(), world.belief()->utime, 0, *world.background()))
    if (keys_by_birth(frames).at(object.anchor->birth) == *wanted) return object.anchor->id();
  return "no such object";
}

World folded(const Scene& scene, const std::vector<std::size_t>& order) {
  World world(scene.knowledge);
  for (std::size_t i : order) {
    Frame frame = scene.frames[i];
    for (Detection& z : frame.detections)
      if (!z.object.empty()) z.object = current_id(world, z.object, scene.frames);
    const Status applied = world.apply(frame);
    EXPECT_TRUE(applied.ok()) << (applied.ok() ? "" : applied.error().text());
  }
  return world;
}

void expect_equal(const World& world, const EnumeratedBelief& expected,
                  const std::vector<Frame>& frames) {
  const Background& background = *world.background();
  const Utime now = world.belief()->utime;
  std::map<ObjectKey, ObjectBelief> believed;
  const auto keys = keys_by_birth(frames);
  for (auto& object : anchors_by_name(world))
    believed.emplace(keys.at(object.anchor->birth), object);
  const int dims = background.dims;
  for (const auto& [key, truth] : expected.objects) {
    const std::string at = "object born in frame " + std::to_string(key.frame) + ", detection " +
                           std::to_string(key.detection);
    const auto found = believed.find(key);
    ASSERT_NEAR(found == believed.end() ? 0 : found->second.p, truth.p_exists, kTolerance) << at;
    if (truth.p_exists < 1e-12) continue;
    const ObjectBelief& object = found->second;
    const Gaussian moments = object.moments(background);
    for (int i = 0; i < dims; ++i) {
      ASSERT_NEAR(moments.mean[i], truth.mean[i], kTolerance) << at;
      for (int j = 0; j < dims; ++j)
        ASSERT_NEAR(moments.covariance(i, j), truth.covariance(i, j), kTolerance) << at;
    }
    const auto classes = object.classes(background);
    for (std::size_t c = 0; c < classes.size(); ++c)
      ASSERT_NEAR(classes[c], truth.classes[c], kTolerance) << at << ", class " << c;
    std::vector<std::vector<double>> models;
    for (const auto& c : truth.models) models.emplace_back(c.size(), 0.0);
    std::map<int, std::vector<double>> symbols;
    std::map<int, double> means, held;
    for (const auto& version : object.versions) {
      const double weight = version.weight(object.p);
      for (std::size_t m = 0; m < version.leaf.models.size(); ++m)
        models[version.leaf.model_class][m] += weight * version.leaf.models[m].weight;
      for (const auto& belief : version.leaf.attributes) {
        held[belief.attribute] += weight;
        means[belief.attribute] += weight * belief.mean;
        auto& sum = symbols[belief.attribute];
        sum.resize(belief.symbols.size(), 0.0);
        for (std::size_t s = 0; s < sum.size(); ++s) sum[s] += weight * belief.symbols[s];
      }
    }
    for (std::size_t c = 0; c < models.size(); ++c)
      for (std::size_t m = 0; m < models[c].size(); ++m)
        ASSERT_NEAR(models[c][m], truth.models[c][m], kTolerance) << at << ", model " << m;
    for (const auto& [attribute, truth_symbols] : truth.symbols) {
      ASSERT_NEAR(held[attribute], truth_symbols.p_held, kTolerance) << at;
      if (truth_symbols.p_held < 1e-9) continue;
      for (std::size_t s = 0; s < truth_symbols.belief.size(); ++s)
        ASSERT_NEAR(symbols[attribute][s] / held[attribute], truth_symbols.belief[s], kTolerance)
            << at << ", symbol " << s;
    }
    for (const auto& [attribute, truth_scalar] : truth.scalars)
      if (truth_scalar.p_held > 1e-9) {
        ASSERT_NEAR(means[attribute] / held[attribute], truth_scalar.mean, kTolerance) << at;
      }
  }
  for (int c = 0; c < background.classes(); ++c) {
    Description description;
    if (background.knowledge.class_attribute >= 0)
      description.terms.push_back({background.knowledge.class_attribute, c});
    ASSERT_NEAR(undetected(*world.belief(), now, description, -1, background),
                expected.undetected[c], kTolerance)
        << "undetected objects of class " << c;
  }
  // A sum of logarithms of some size: relative to it.
  const double log_evidence = std::log(expected.evidence) - expected.expected_detections;
  ASSERT_NEAR(world.belief()->log_evidence, log_evidence,
              kTolerance * (1 + std::abs(log_evidence)));
}

std::vector<std::size_t> in_order(const Scene& scene) {
  std::vector<std::size_t> order(scene.frames.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  return order;
}

TEST(Exactness, EqualsTheEnumerationOfEveryAssociation) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    const Scene scene = random_scene(random, enumeration::random_variety(random));
    SCOPED_TRACE("seed " + std::to_string(seed));
    const World world = folded(scene, in_order(scene));
    expect_equal(world, enumeration::enumerate(scene.knowledge, scene.frames), scene.frames);
    if (HasFatalFailure()) return;
  }
}

TEST(Exactness, LateFramesArePutInTheirPlace) {
  int late = 0;
  for (std::uint64_t seed = 1000; seed < 1100; ++seed) {
    std::mt19937_64 random(seed);
    enumeration::Variety variety = enumeration::random_variety(random);
    variety.sensors = variety.late = true;
    variety.verification = false;
    const Scene scene = random_scene(random, variety);
    SCOPED_TRACE("seed " + std::to_string(seed));
    const World world = folded(scene, scene.arrival);
    late += static_cast<int>(world.late_frames());
    expect_equal(world, enumeration::enumerate(scene.knowledge, scene.frames), scene.frames);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(late, 50) << "the scenes must have late frames";
}

}  // namespace
}  // namespace anchord
