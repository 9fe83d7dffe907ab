#include "tests/anchor_tune/street.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/anchoring/dice.h"
#include "tests/anchoring/small_world.h"

namespace anchord::tuning {
namespace {

using enumeration::Dice;

struct Walker {
  int id;
  Eigen::Vector2d position, velocity;
  bool hidden;
};

/// Knuth's product of uniform numbers; for means of some ten.
int poisson(double mean, Dice& dice) {
  int n = 0;
  for (double product = dice.uniform(0, 1); product > std::exp(-mean);
       product *= dice.uniform(0, 1))
    ++n;
  return n;
}

class Simulation {
 public:
  Simulation(const Street& street, Dice& dice) : s_(street), dice_(dice) {
    come(walkers_, s_.undetected_intensity * area());
    // As many as there are after a long time.
    come(ghosts_, s_.ghosts.arrival_rate / s_.ghosts.departure_rate * area());
  }

  void step() {
    const double dt = s_.seconds_per_frame;
    step(walkers_, s_.departure_rate);
    come(walkers_, s_.arrival_rate * area() * dt);
    if (s_.ghosts.arrival_rate <= 0) return;
    step(ghosts_, s_.ghosts.departure_rate);
    come(ghosts_, s_.ghosts.arrival_rate * area() * dt);
  }

  void step(std::vector<Walker>& walkers, double departure_rate) {
    const double dt = s_.seconds_per_frame;
    std::erase_if(walkers,
                  [&](const Walker&) { return dice_.chance(-std::expm1(-departure_rate * dt)); });
    for (Walker& w : walkers) {
      for (int axis = 0; axis < 2; ++axis) {
        // Position and velocity together have the covariance of white acceleration.
        const double push = dice_.normal() * std::sqrt(s_.psd * dt);
        w.position[axis] += w.velocity[axis] * dt + push * dt / 2 +
                            dice_.normal() * std::sqrt(s_.psd * dt * dt * dt / 12);
        w.velocity[axis] += push;
      }
      const double both = s_.hide + s_.show;
      const double changes = both > 0 ? -std::expm1(-both * dt) / both : 0;
      if (dice_.chance((w.hidden ? s_.show : s_.hide) * changes)) w.hidden = !w.hidden;
    }
  }

  Frame look(double seconds) {
    Frame f = frame(seconds, {}, "camera");
    f.view.emplace().type = View::Type::kWorld;
    if (s_.per_m != 0) f.pose.emplace();
    const double deviation = std::sqrt(s_.variance);
    const auto see = [&](const std::vector<Walker>& walkers, DetectionProbability p) {
      for (const Walker& w : walkers)
        if (!w.hidden && dice_.chance(p.at(w.position.norm())))
          f.detections.push_back(at(w.position.x() + deviation * dice_.normal(),
                                    w.position.y() + deviation * dice_.normal(), s_.variance));
    };
    see(walkers_, {s_.detection_probability, s_.per_m});
    see(ghosts_, s_.ghosts.detection_probability);
    for (int n = poisson(s_.clutter_density * area(), dice_); n > 0; --n)
      f.detections.push_back(at(dice_.uniform(0, s_.side), dice_.uniform(0, s_.side), s_.variance));
    return f;
  }

  std::vector<TruthRow> rows() const {
    std::vector<TruthRow> rows;
    for (const Walker& w : walkers_)
      rows.push_back({std::to_string(w.id), {w.position.x(), w.position.y(), 0}, "object", false});
    return rows;
  }

 private:
  double area() const { return s_.side * s_.side; }

  void come(std::vector<Walker>& walkers, double expected) {
    const double hidden = s_.hide > 0 ? s_.hide / (s_.hide + s_.show) : 0;
    const double speed = std::sqrt(s_.velocity_variance);
    for (int n = expected > 0 ? poisson(expected, dice_) : 0; n > 0; --n)
      walkers.push_back({ids_++,
                         {dice_.uniform(0, s_.side), dice_.uniform(0, s_.side)},
                         {speed * dice_.normal(), speed * dice_.normal()},
                         dice_.chance(hidden)});
  }

  const Street& s_;
  Dice& dice_;
  std::vector<Walker> walkers_, ghosts_;
  int ids_ = 0;
};

}  // namespace

Recording simulate(const Street& street, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Dice dice(random);
  Simulation simulation(street, dice);
  Recording out;
  out.truth.emplace();
  for (int k = 0; k < street.frames; ++k) {
    if (k > 0) simulation.step();
    out.frames.push_back(simulation.look(k * street.seconds_per_frame));
    (*out.truth)[out.frames.back().utime] = simulation.rows();
  }
  return out;
}

std::string configuration_of(const Street& s) {
  using nlohmann::json;
  json model{{"kind", "constant_velocity"},
             {"acceleration_psd", s.psd},
             {"initial_velocity_variance", s.velocity_variance},
             {"initial_weight", 1}};
  json object{{"models", {model}},
              {"detection_probability", s.detection_probability},
              {"arrival_rate", s.arrival_rate},
              {"departure_rate", s.departure_rate},
              {"undetected_intensity", s.undetected_intensity}};
  if (s.per_m != 0) object["detection_probability"] = {s.detection_probability, s.per_m};
  if (s.hide > 0) {
    model["detectable"] = false;
    model["initial_weight"] = 0;
    object["models"].push_back(model);
    object["transitions"] = {{{"from", 0}, {"to", 1}, {"rate", s.hide}},
                             {{"from", 1}, {"to", 0}, {"rate", s.show}}};
  }
  json out{
      {"world",
       {{"dimensions", 2}, {"bounds", {{"min", {0, 0}}, {"max", {s.side, s.side}}}}, {"cell", 1}}},
      {"classes", {{"default", object}}},
      {"sensors", {{"default", {{"clutter_density", s.clutter_density}}}}}};
  if (s.ghosts.arrival_rate > 0) {
    json ghost = object;
    ghost["phantom"] = true;
    ghost["detection_probability"] = s.ghosts.detection_probability;
    ghost["arrival_rate"] = s.ghosts.arrival_rate;
    ghost["departure_rate"] = s.ghosts.departure_rate;
    ghost["undetected_intensity"] = s.ghosts.arrival_rate / s.ghosts.departure_rate;
    out["attributes"]["class"] = {{"kind", "categorical"}, {"symbols", {"object", "ghost"}}};
    out["classes"]["ghost"] = ghost;
  }
  return out.dump();
}

Knowledge knowledge_of(const Street& street) { return knowledge_from(configuration_of(street)); }

}  // namespace anchord::tuning
