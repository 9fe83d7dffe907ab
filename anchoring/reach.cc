#include "anchoring/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "anchoring/belief.h"

namespace anchord {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSlack = 1e-6;   // m: rounding of positions on the map, with room
constexpr double kEarly = 0.999;  // of a time computed: the same for the exponentials in it
constexpr Utime kNever = std::numeric_limits<Utime>::max();
constexpr double kLongest = 1e10;  // s: what is due later never is

Utime after(Utime utime, double seconds) {
  return seconds < kLongest ? utime + from_seconds(kEarly * seconds) : kNever;
}

/// Seconds until a leaf may exist with less probability than `least`, or less than that. What stays
/// of a mixture of classes is convex in time, in the log domain: a tangent is below it.
double until_departed(const Leaf& leaf, double least, const Background& background) {
  if (leaf.existence < least) return 0;
  if (leaf.held || least <= 0) return kInfinity;
  double t = 0;
  for (int tangent = 0; tangent < 4; ++tangent) {
    double stays = 0, loss = 0;
    for (int c = 0; c < background.classes(); ++c) {
      const double mu = background.object_class(c).departure_rate;
      const double still = t > 0 ? leaf.classes[c] * std::exp(-mu * t) : leaf.classes[c];
      stays += still;
      loss += mu * still;
    }
    if (loss <= 0) return kInfinity;
    t += std::log(leaf.existence * stays / least) * stays / loss;
    if (background.classes() == 1) break;  // its own tangent
  }
  return t;
}

/// Seconds until departures may make another class the most probable one.
double until_other_class(const Leaf& leaf, const Background& background) {
  const int top = leaf.top_class();
  if (top != leaf.model_class) return 0;
  double t = kInfinity;
  for (int c = 0; c < background.classes(); ++c) {
    const double faster =
        background.object_class(top).departure_rate - background.object_class(c).departure_rate;
    if (faster > 0 && leaf.classes[c] > 0)
      t = std::min(t, std::log(leaf.classes[top] / leaf.classes[c]) / faster);
  }
  return leaf.held ? kInfinity : t;
}

void include(Reach::Axis& axis, const Kinematic& k, const BehaviourModel& model, int i) {
  const bool moves = model.kind == BehaviourModel::Kind::kConstantVelocity;
  const double velocity = moves ? k.velocity[i] : 0;
  Reach::Axis other{k.position[i],
                    k.position[i],
                    std::min(velocity, 0.0),
                    std::max(velocity, 0.0),
                    {k.pp(i, i), 0, 0, 0}};
  if (moves)
    other.variance = {k.pp(i, i), std::max(2 * k.pv(i, i), 0.0), k.vv(i, i), model.psd[i] / 3};
  else
    other.variance[1] = model.psd[i];
  axis.low = std::min(axis.low, other.low);
  axis.high = std::max(axis.high, other.high);
  axis.slowest = std::min(axis.slowest, other.slowest);
  axis.fastest = std::max(axis.fastest, other.fastest);
  for (int n = 0; n < 4; ++n) axis.variance[n] = std::max(axis.variance[n], other.variance[n]);
}

}  // namespace

bool Reach::Axis::meets(double min, double max, double dt, double deviations,
                        double more_variance) const {
  const double spread =
      variance[0] + dt * (variance[1] + dt * (variance[2] + dt * variance[3])) + more_variance;
  const double reach = kSlack + deviations * std::sqrt(spread);
  return low + slowest * dt - reach <= max && high + fastest * dt + reach >= min;
}

Window Window::of(Utime utime, const std::array<double, 4>& box, double deviations, double variance,
                  const Background& background) {
  const double reach = kSlack + deviations * std::sqrt(variance);
  const std::array<double, 4> wide{box[0] - reach, box[1] - reach, box[2] + reach, box[3] + reach};
  return {utime, box, deviations, variance, background.places_in(wide)};
}

Reach::Reach()
    : from(kNever), axis{Axis{kInfinity, -kInfinity}, Axis{kInfinity, -kInfinity}}, due(kNever) {}

Reach Reach::of(const Cluster& cluster, const Background& background) {
  Reach reach;
  Utime departed = 0;  // when the last leaf may have
  for (const AnchorTree& tree : cluster.anchors)
    for (const auto& at : tree.leaves) {
      const Leaf& leaf = *at;
      const auto& dynamics = background.dynamics[leaf.model_class];
      const auto& models = background.object_class(leaf.model_class).models;
      reach.from = std::min(reach.from, leaf.utime);
      if (dynamics.exchanges) reach.due = std::min(reach.due, leaf.utime);
      reach.due = std::min(reach.due, after(leaf.utime, until_other_class(leaf, background)));
      const double lasts =
          until_departed(leaf, background.knowledge.limits.min_existence, background);
      departed = std::max(departed, after(leaf.utime, lasts));
      for (std::size_t m = 0; m < leaf.models.size(); ++m) {
        const ModelState& state = leaf.models[m];
        if (const auto* kinematic = std::get_if<Kinematic>(&state.density)) {
          for (int i = 0; i < 2; ++i) anchord::include(reach.axis[i], *kinematic, models[m], i);
        } else if (state.weight > 0 || !models[m].implied) {
          reach.places |= background.bit_of(*std::get<Somewhere>(state.density).footprint());
        }
      }
    }
  reach.due = std::min(reach.due, departed);
  return reach;
}

void Reach::include(const Reach& other) {
  from = std::min(from, other.from);
  for (int i = 0; i < 2; ++i) {
    Axis& a = axis[i];
    const Axis& b = other.axis[i];
    a.low = std::min(a.low, b.low);
    a.high = std::max(a.high, b.high);
    a.slowest = std::min(a.slowest, b.slowest);
    a.fastest = std::max(a.fastest, b.fastest);
    for (int n = 0; n < 4; ++n) a.variance[n] = std::max(a.variance[n], b.variance[n]);
  }
  places |= other.places;
  due = std::min(due, other.due);
}

bool Reach::meets(const Window& window) const {
  if (places & window.places) return true;
  const double dt = seconds_between(from, window.utime);
  for (int i = 0; i < 2; ++i)
    if (!axis[i].meets(window.box[i], window.box[i + 2], dt, window.deviations, window.variance))
      return false;
  return true;
}

}  // namespace anchord
