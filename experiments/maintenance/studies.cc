#include "experiments/maintenance/studies.h"

#include <utility>

namespace anchord::experiment {
namespace {

using Kind = Strategy::Kind;
using Planner = Maintenance::Planner;
using MakeScene = std::function<Scene(Dice&)>;

/// A scene with the planner's settings.
MakeScene with(MakeScene make, Planner planner, double threshold, double omega) {
  return [=](Dice& dice) {
    Scene scene = make(dice);
    Maintenance& settings = scene.knowledge.maintenance;
    settings.planner = planner;
    settings.threshold = threshold;
    settings.omega = omega;
    return scene;
  };
}

MakeScene room(const RoomOptions& options = {}) {
  return [=](Dice& dice) { return thesis_room(options, dice); };
}

Strategy tour(double pause = 0, int eye = 0) {
  Strategy out;
  out.kind = Kind::kTour;
  out.pause = pause;
  out.eye = eye;
  out.looks_idle = true;  // while it rests; without a pause it never does
  return out;
}

/// With the planner's own limits, not the thesis' one viewpoint per object.
Strategy planner() {
  Strategy out;
  out.limits = {};
  return out;
}

std::vector<Point> threshold_study() {
  std::vector<Point> out{{"threshold", "", "tour", 0, room(), tour(), {}}};
  for (int t = 1; t <= 16; ++t)
    out.push_back(
        {"threshold", "", "greedy", 1.0 * t, with(room(), Planner::kGreedy, t, 0.75), {}, {}});
  for (const int t : {1, 4, 8, 12, 16})
    out.push_back({"threshold",
                   "",
                   "look-ahead",
                   1.0 * t,
                   with(room(), Planner::kLookahead, t, 0.75),
                   planner(),
                   {},
                   5});
  return out;
}

std::vector<Point> omega_study() {
  std::vector<Point> out{{"omega", "", "tour", 0, room(), tour(), {}}};
  for (const double w : {0.05, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.7, 2.0})
    out.push_back({"omega", "", "greedy", w, with(room(), Planner::kGreedy, 8, w), {}, {}});
  for (const double w : {0.05, 1.0, 2.0})
    out.push_back(
        {"omega", "", "look-ahead", w, with(room(), Planner::kLookahead, 8, w), planner(), {}, 5});
  return out;
}

std::vector<Point> sensitivity_study() {
  struct Variant {
    std::string name;
    RoomOptions room;
    double initial_variance = 0.01, approach = 0;
    Strategy how;
  };
  std::vector<Variant> variants;
  const auto vary = [&](const std::string& name) -> Variant& {
    variants.push_back({name, {}, 0.01, 0, {}});
    return variants.back();
  };
  vary("as chosen");
  vary("sees all round").room.half_width = 3.14159265;
  vary("sees 60 degrees").room.half_width = 0.5236;
  vary("speed halved").room.speed = 0.53;
  vary("speed doubled").room.speed = 2.11;
  vary("noise a tenth").room.most_psd = 0.001;
  vary("noise ten times").room.most_psd = 0.1;
  vary("step of 0.5 s").room.step = 0.5;
  vary("step of 2 s").room.step = 2;
  vary("three dimensions").room.dims = 3;
  vary("gain against the present entropy").how.kind = Kind::kPresent;
  vary("1 m^2 at first").initial_variance = 1;
  vary("drives up to the object").approach = 0.45;
  vary("looks while idle").how.looks_idle = true;
  std::vector<Point> out;
  for (const Variant& v : variants) {
    const MakeScene make = [v](Dice& dice) {
      Scene scene = thesis_room(v.room, dice);
      scene.initial_variance = v.initial_variance;
      scene.approach = v.approach;
      return scene;
    };
    Span span;
    span.step = v.room.step;
    const auto add = [&](const std::string& strategy, double value, const MakeScene& scene,
                         const Strategy& how) {
      out.push_back({"sensitivity", v.name, strategy, value, scene, how, span, 5});
    };
    add("tour", 0, make, tour());
    for (const int t : {1, 4, 6, 8, 9, 10, 16})
      add("greedy by threshold", t, with(make, Planner::kGreedy, t, 0.75), v.how);
    for (const double w : {0.05, 1.0, 1.7})
      add("greedy by omega", w, with(make, Planner::kGreedy, 8, w), v.how);
  }
  return out;
}

std::vector<Point> unreliable_study() {
  std::vector<Point> out;
  const Span span{600, 100, 1, 5};
  const MakeScene scene = unreliable_room;
  for (const double pause : {0.0, 4.0, 12.0})
    out.push_back({"unreliable", "", "tour", pause, scene, tour(pause), span, 8});
  for (const double w : {0.75, 2.0, 4.0})
    out.push_back(
        {"unreliable", "", "greedy", w, with(scene, Planner::kGreedy, 1, w), planner(), span, 8});
  for (const double w : {0.75, 1.5, 3.0})
    out.push_back({"unreliable", "", "look-ahead", w, with(scene, Planner::kLookahead, 1, w),
                   planner(), span, 8});
  return out;
}

/// The house, with things that move about as in the thesis, or a tenth of that.
std::vector<Point> house_study(const std::string& variant, double most_psd) {
  std::vector<Point> out;
  const MakeScene scene = [=](Dice& dice) { return house(most_psd, dice); };
  const Span span{800, 200, 1, 1};
  const auto add = [&](const std::string& strategy, double value, const MakeScene& make,
                       const Strategy& how) {
    out.push_back({"house", variant, strategy, value, make, how, span, 8});
  };
  for (const double pause : {0.0, 5.0, 10.0, 20.0, 40.0}) add("tour", pause, scene, tour(pause));
  for (const double pause : {0.0, 5.0})
    add("tour by the near sensor", pause, scene, tour(pause, 1));
  for (const double t : {1.0, 25.0, 30.0, 40.0, 50.0})
    add("greedy by threshold", t, with(scene, Planner::kGreedy, t, 0.75), planner());
  for (const double w : {0.75, 4.0, 8.0, 10.0, 12.0, 14.0})
    add("greedy by omega", w, with(scene, Planner::kGreedy, 1, w), planner());
  for (const double w : {0.75, 2.0, 3.0, 4.0, 5.0, 7.0})
    add("look-ahead", w, with(scene, Planner::kLookahead, 0.5, w), planner());
  for (const double pause : {0.0, 4.0, 16.0, 32.0, 64.0}) {
    Strategy patrol;
    patrol.kind = Kind::kPatrol;
    patrol.pause = pause;
    add("patrol", pause, scene, patrol);
  }
  return out;
}

}  // namespace

const std::vector<std::string>& study_names() {
  static const std::vector<std::string> names{"threshold",  "omega", "sensitivity",
                                              "unreliable", "house", "quiet house"};
  return names;
}

std::vector<Point> points_of(const std::string& study) {
  if (study == "threshold") return threshold_study();
  if (study == "omega") return omega_study();
  if (study == "sensitivity") return sensitivity_study();
  if (study == "unreliable") return unreliable_study();
  if (study == "house") return house_study("at most 0.01 m^2/s", 0.01);
  if (study == "quiet house") return house_study("at most 0.001 m^2/s", 0.001);
  return {};
}

}  // namespace anchord::experiment
