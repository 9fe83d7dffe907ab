#include "tests/anchoring/older_checkpoint.h"

#include <gtest/gtest.h>

#include "tests/anchoring/small_events.h"
#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

constexpr const char* kConfiguration = R"({
  "world": {"dimensions": 2, "bounds": {"min": [0, 0], "max": [6, 4]}, "cell": 0.5,
            "max_lateness": 0.5},
  "places": [
    {"name": "kitchen", "polygon": [[0, 0], [3, 0], [3, 4], [0, 4]]},
    {"name": "table", "parent": "kitchen", "polygon": [[1, 1], [2, 1], [2, 2], [1, 2]]}],
  "attributes": {
    "class": {"kind": "categorical", "symbols": ["cup", "cat", "ghost"]},
    "color": {"kind": "categorical", "symbols": ["red", "green", "blue"]},
    "size": {"kind": "scalar", "unit": "m", "predicates": {"small": [0, 0.15]}}},
  "classes": {
    "default": {
      "models": [{"kind": "constant_position", "position_psd": 1e-4},
                 {"kind": "somewhere", "place": "table", "rate": 0.01},
                 {"kind": "somewhere", "rate": 0.001}],
      "detection_probability": 0.9, "undetected_intensity": 0.01, "arrival_rate": 1e-5,
      "departure_rate": 1e-4},
    "cat": {"models": [{"kind": "constant_velocity"}, {"kind": "constant_position"}],
            "transitions": [{"from": 0, "to": 1, "rate": 0.1}, {"from": 1, "to": 0, "rate": 0.1}],
            "arrivals": [{"mean": [6, 2], "covariance": [0.1, 0, 0, 0.1], "rate": 0.01,
                          "moves": true, "velocity": [-0.5, 0]}]},
    "ghost": {"phantom": true}},
  "sensors": {"default": {"clutter_density": 1e-3, "view": {"type": "world"},
                          "real_share": 0.8, "score_memory": {"share": 0.5, "seconds": 10}}}
})";

Detection scored(Detection z, double score) {
  z.score = score;
  return z;
}

Detection sized(Detection z, double mean) {
  z.attributes.push_back({"size", ScalarReport{mean, 1e-4}});
  return z;
}

/// By a sensor that sees the strip up to x.
Frame up_to(double x, Frame frame) {
  View view;
  view.type = View::Type::kPolygon;
  view.points = {{0, 0}, {x, 0}, {x, 4}, {0, 4}};
  frame.view = view;
  return frame;
}

}  // namespace

void take(World& world, const Accepted& step) {
  if (const auto* frame = std::get_if<Frame>(&step.what))
    ASSERT_TRUE(world.apply(*frame, step.work).ok());
  else
    ASSERT_TRUE(world.apply(std::get<Event>(step.what)).ok());
}

OlderScene older_scene() {
  const Detection cup = sized(at(1.25, 1.25, "class", "cup", 0.9), 0.1);
  const Detection other = at(1.3, 1.27, "color", "red", 0.7);
  const Detection cat = at(4, 2, "class", "cat", 0.8);
  const Detection false_one = scored(at(2.6, 3.1, "class", "cup", 0.6), 0.2);
  OlderScene scene{knowledge_from(kConfiguration), {}, {}};
  scene.before = {
      {frame(0, {cup, other, cat})},
      {frame(0.5, {scored(cup, 0.9), other, false_one})},
      {frame(1, {cup, scored(other, 0.7), cat, at(5.1, 0.6)})},
      {up_to(2.6, frame(1.2, {cup}, "narrow"))},
      {named(1.3, "cup-1", "mine")},
      {frame(1.5, {other, at(4.1, 2.05), at(5.1, 0.6)})},
      {joined(1.6, "cup-1", "cup-2")},
      {frame(2, {cup, at(4.2, 2.1), at(5.1, 0.6, "class", "cup", 0.6)})},
      {missing(2.1, "cup-1", box_of_interest(1, 1, 1.5, 2))},
      {event(Event::Kind::kDropped, 2.2, "cat-1")},
      {up_to(2.6, frame(2.4, {false_one, at(1.2, 1.3, 0.01)}, "narrow")), 60},
      {frame(2.5, {at(4.3, 2.1), false_one})},
      {event(Event::Kind::kGrasped, 2.6, "cup-1")},
      {frame(2.45, {at(1.25, 1.25)}, "late")},
  };
  scene.after = {
      {frame(2.7, {at(4.4, 2.1)})},
      {undone(2.75, 7)},
      {frame(2.65, {at(1.25, 1.25)}, "late")},
      {frame(3, {cup, other, at(4.5, 2.1)})},
      {frame(9, {cup, at(4.5, 2.2), at(2, 3, "color", "blue", 0.9)})},
  };
  return scene;
}

}  // namespace anchord
