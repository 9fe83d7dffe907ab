#include "tests/anchoring/small_world.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "api/world_line.h"
#include "knowledge/configuration.h"

namespace anchord {
namespace {

constexpr const char* kApartment = R"({
  "world": {"dimensions": 2, "bounds": {"min": [0, 0], "max": [6, 4]}, "cell": 0.25,
            "max_lateness": 0.5},
  "places": [
    {"name": "kitchen", "kind": "room", "polygon": [[0, 0], [3, 0], [3, 4], [0, 4]]},
    {"name": "table", "kind": "surface", "parent": "kitchen",
     "polygon": [[1, 1], [2, 1], [2, 2], [1, 2]]},
    {"name": "hall", "kind": "room", "polygon": [[3, 0], [6, 0], [6, 4], [3, 4]]}],
  "attributes": {
    "class": {"kind": "categorical", "symbols": ["cup", "box"]},
    "color": {"kind": "categorical", "symbols": ["red", "green", "blue"]},
    "size": {"kind": "scalar", "unit": "m",
             "predicates": {"small": [0, 0.15], "large": [0.15, 0.5]}}},
  "classes": {"default": {
    "models": [{"kind": "constant_position", "position_psd": 0}],
    "detection_probability": 0.9, "undetected_intensity": 0.01, "arrival_rate": 0,
    "departure_rate": 0}},
  "sensors": {"default": {"clutter_density": 1e-3, "view": {"type": "world"}}}
})";

}  // namespace

Knowledge knowledge_from(std::string_view configuration) {
  const Configuration read = parse_configuration(configuration);
  for (const auto& mistake : read.mistakes()) std::fprintf(stderr, "%s\n", mistake.text().c_str());
  if (!read.ok()) std::abort();
  return read.knowledge();
}

Knowledge small_world(std::string_view more) {
  auto json = nlohmann::json::parse(kApartment);
  const auto merge = [](auto& self, nlohmann::json& to, const nlohmann::json& from) -> void {
    for (const auto& [key, value] : from.items())
      if (value.is_object() && to.contains(key))
        self(self, to[key], value);
      else
        to[key] = value;
  };
  merge(merge, json, nlohmann::json::parse(more));
  return knowledge_from(json.dump());
}

Utime at_second(double seconds) { return 1'700'000'000'000'000 + from_seconds(seconds); }

Detection at(double x, double y, double variance) {
  Detection z;
  z.measurement = CartesianMeasurement{{x, y}, {variance, 0, 0, variance}};
  return z;
}

Detection at(double x, double y, const std::string& attribute, const std::string& symbol,
             double p) {
  Detection z = at(x, y);
  z.attributes.push_back({attribute, SymbolReport{{{symbol, p}}}});
  return z;
}

Frame frame(double seconds, std::vector<Detection> detections, const std::string& sensor) {
  Frame out;
  out.utime = at_second(seconds);
  out.sensor = sensor;
  out.detections = std::move(detections);
  return out;
}

std::vector<Detection> rows(enumeration::Dice& dice, int objects, int row, double apart,
                            double deviation, double clutter) {
  const double variance = deviation * deviation;
  std::vector<Detection> seen;
  for (int object = 0; object < objects; ++object)
    if (dice.chance(0.9))
      seen.push_back(
          at(1 + apart * (object / row) + 0.2 * (object % row) + deviation * dice.normal(),
             1 + deviation * dice.normal(), variance));
  if (dice.chance(clutter)) seen.push_back(at(dice.uniform(0, 6), dice.uniform(0, 4), variance));
  return seen;
}

Frame blink(double seconds) {
  Frame out = frame(seconds, {}, "shut_eye");
  out.view = View{};
  return out;
}

void apply(World& world, const std::vector<Frame>& frames) {
  for (const Frame& f : frames) {
    const Status done = world.apply(f);
    ASSERT_TRUE(done.ok()) << done.error().text();
  }
}

std::string everything(const World& world) {
  constexpr int kAllOfThem = 1'000'000;
  WorldLineOptions options;
  options.all = true;
  options.hypotheses = kAllOfThem;
  return world_line(*world.belief(), *world.background(), options).dump();
}

std::vector<ObjectBelief> anchors_by_name(const World& world) {
  std::vector<ObjectBelief> out;
  for (const auto& cluster : world.belief()->clusters)
    for (std::size_t a = 0; a < cluster->anchors.size(); ++a) {
      ObjectBelief& object = out.emplace_back();
      object.anchor = cluster->anchors[a].anchor;
      for (const auto& leaf : cluster->anchors[a].leaves) {
        Leaf now = *leaf;
        if (now.utime < world.belief()->utime)
          predict(now, world.belief()->utime, *world.background());
        object.versions.push_back({0, as_real(std::move(now), *world.background())});
      }
      for (const Hypothesis& h : cluster->hypotheses)
        if (h.leaf[a] != Hypothesis::kNoLeaf)
          object.versions[h.leaf[a]].probability += std::exp(h.log_weight);
      for (const auto& version : object.versions)
        object.p += version.probability * version.leaf.existence;
    }
  return out;
}

std::vector<ObjectBelief> objects(const World& world) {
  return read_objects(*world.belief(), world.belief()->utime, 0, *world.background());
}

std::vector<std::string> ids(const World& world) {
  std::vector<std::string> out;
  for (const auto& object : objects(world)) out.push_back(object.anchor->id());
  return out;
}

}  // namespace anchord
