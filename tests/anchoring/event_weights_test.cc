// A belief is a belief after anything that can be done and said.

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

using Kind = Event::Kind;

constexpr double kRounding = 1e-9;  // sums of up to thousands of terms

void check_sums(const World& world) {
  for (const auto& cluster : world.belief()->clusters) {
    double sum = 0;
    for (const Hypothesis& h : cluster->hypotheses) sum += std::exp(h.log_weight);
    RC_ASSERT(std::abs(sum - 1) < kRounding);
    RC_ASSERT(cluster->leading < static_cast<int>(cluster->hypotheses.size()));
    for (std::size_t a = 0; a < cluster->anchors.size(); ++a) {
      bool used = false;
      for (const Hypothesis& h : cluster->hypotheses) {
        RC_ASSERT(h.leaf.size() == cluster->anchors.size());
        RC_ASSERT(h.leaf[a] < static_cast<int>(cluster->anchors[a].leaves.size()));
        used = used || h.leaf[a] != Hypothesis::kNoLeaf;
      }
      RC_ASSERT(used);
      for (const auto& leaf : cluster->anchors[a].leaves) {
        double weights = 0, classes = 0;
        for (const ModelState& m : leaf->models) weights += m.weight;
        for (const double b : leaf->classes) classes += b;
        RC_ASSERT(std::abs(weights - 1) < kRounding);
        RC_ASSERT(std::abs(classes - 1) < kRounding);
        RC_ASSERT(leaf->existence >= 0);
        RC_ASSERT(leaf->existence <= 1 + kRounding);
      }
    }
  }
  const Background& background = *world.background();
  for (const ObjectBelief& object : objects(world)) {
    RC_ASSERT(object.moments(background).mean.allFinite());
    const double kitchen = object.in_place(0, background), hall = object.in_place(2, background);
    RC_ASSERT(kitchen + hall < 1 + kRounding);
  }
}

RegionOfInterest some_region() {
  const auto x = *rc::gen::inRange(-4, 20) * 0.25, y = *rc::gen::inRange(-4, 12) * 0.25;
  const auto w = *rc::gen::inRange(1, 32) * 0.2, h = *rc::gen::inRange(1, 24) * 0.2;
  if (*rc::gen::arbitrary<bool>()) return box_of_interest(x, y, x + w, y + h);
  RegionOfInterest region;
  region.center = {x, y, 0};
  region.covariance = {0.1 * w, 0.01, 0, 0.01, 0.1 * h, 0, 0, 0, 0.1};
  region.radius = 2.45;
  return region;
}

Event some_event(const World& world, double seconds) {
  const auto kind = static_cast<Kind>(*rc::gen::inRange(0, 10));
  std::vector<std::string> names = ids(world);
  names.insert(names.end(), {"mug", "jar", "cup-1"});
  const auto name = [&] { return *rc::gen::elementOf(names); };
  Event e = event(kind, seconds, name());
  if (kind == Kind::kMissing) {
    e.sensor = "eye";
    e.regions.resize(*rc::gen::inRange<std::size_t>(1, 3));
    for (auto& region : e.regions) region = some_region();
  }
  if (kind == Kind::kNamed) e.other = *rc::gen::element<std::string>("", "mug", "jar");
  if (kind == Kind::kJoined) e.other = name();
  if (kind == Kind::kUndone) {
    const auto& kept = world.belief()->set_aside;
    e.undone = kept.empty() ? 1 : (*rc::gen::elementOf(kept)).number;
  }
  if (kind == Kind::kCarried || *rc::gen::inRange(0, 3) == 0)
    e.position = {*rc::gen::inRange(-2, 26) * 0.25, *rc::gen::inRange(-2, 18) * 0.25, 0};
  if (*rc::gen::inRange(0, 3) == 0)
    e.place = *rc::gen::element<std::string>("kitchen", "table", "hall");
  return e;
}

/// `steps` frames and events about objects in three spots that are close enough to be mistaken.
void play(const Knowledge& knowledge, int steps, int most_detections) {
  World world(knowledge);
  double seconds = 0;
  int taken = 0;
  for (int step = 0; step < steps; ++step) {
    seconds += *rc::gen::inRange(0, 6) * 0.1;
    if (step < 2 || *rc::gen::arbitrary<bool>()) {
      Frame f = frame(seconds += 1e-3, {});
      for (int n = *rc::gen::inRange(0, most_detections + 1); n > 0; --n) {
        f.detections.push_back(at(1 + 0.15 * *rc::gen::inRange(0, 6), 1.5, 0.01));
        if (*rc::gen::arbitrary<bool>())
          f.detections.back().attributes.push_back(
              {"class", SymbolReport{{{*rc::gen::element<std::string>("cup", "box"), 0.8}}}});
        if (*rc::gen::inRange(0, 4) == 0)
          f.detections.back().object = *rc::gen::element<std::string>("cup-1", "mug");
      }
      RC_ASSERT(world.apply(f).ok());
    } else {
      taken += world.apply(some_event(world, seconds - *rc::gen::inRange(-2, 4) * 0.1)).ok();
    }
    check_sums(world);
  }
  RC_TAG(taken > 0 ? "with events" : "without");
}

constexpr const char* kHome = R"({"classes": {
    "default": {"departure_rate": 0.01, "models": [
      {"kind": "constant_velocity", "acceleration_psd": 0.1, "initial_velocity_variance": 0.1},
      {"kind": "constant_velocity", "acceleration_psd": 0.1, "detectable": false},
      {"kind": "somewhere", "place": "kitchen", "rate": 0.05}],
      "transitions": [{"from": 0, "to": 1, "rate": 0.2}, {"from": 1, "to": 0, "rate": 0.5}]},
    "box": {"models": [{"kind": "constant_position", "position_psd": 0.01}], "transitions": []}}})";

RC_GTEST_PROP(EventWeights, SumToOneWithLimits, ()) {
  play(small_world(*rc::gen::arbitrary<bool>() ? kHome : "{}"), 14, 3);
}

RC_GTEST_PROP(EventWeights, SumToOneWithoutLimits, ()) { play(small_world(kExact), 7, 2); }

}  // namespace
}  // namespace anchord
