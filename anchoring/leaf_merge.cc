#include <algorithm>
#include <cmath>

#include "anchoring/leaf.h"
#include "anchoring/shared_detection.h"

namespace anchord {
namespace {

Kinematic moments(const ModelState& state, const BehaviourModel& from, const BehaviourModel& target,
                  int dims) {
  const auto* somewhere = std::get_if<Somewhere>(&state.density);
  if (from.shares() && target.shares()) return std::get<Kinematic>(state.density);
  return as_model(somewhere ? kinematic_at(somewhere->moments(), 0, dims)
                            : own_place(std::get<Kinematic>(state.density), from),
                  target, dims);
}

/// The model of the new class that takes the density of an old one: same kind and place, not
/// taken yet; else the first of its sort; else (a `somewhere` where there is none) the first
/// tracked one.
int heir(const BehaviourModel& old, const std::vector<BehaviourModel>& models,
         std::vector<char>& taken) {
  for (std::size_t m = 0; m < models.size(); ++m)
    if (!taken[m] && models[m].kind == old.kind && models[m].place == old.place &&
        models[m].shares() == old.shares() && (old.implied || !models[m].implied)) {
      taken[m] = 1;
      return static_cast<int>(m);
    }
  for (std::size_t m = 0; m < models.size(); ++m)
    if (models[m].tracked() == old.tracked() && (old.implied || !models[m].implied))
      return static_cast<int>(m);
  for (std::size_t m = 0; m < models.size(); ++m)
    if (models[m].tracked()) return static_cast<int>(m);
  return 0;
}

/// Adds weight and density to a model that has `to.weight` of its own. `as_it_is`: a `somewhere`
/// over the same place, or over one that an event has told.
void take_over(ModelState& to, const ModelState& from, const BehaviourModel& old,
               const BehaviourModel& model, bool as_it_is, int dims) {
  if (model.tracked()) {
    const Kinematic arriving = moments(from, old, model, dims);
    auto& density = std::get<Kinematic>(to.density);
    if (to.weight > 0 && from.weight > 0)
      density = merge(to.weight, density, from.weight, arriving);
    else if (to.weight <= 0)
      density = arriving;
    if (to.weight > 0 && from.weight > 0)
      to.seen = SeenShare::merge(to.weight, to.seen, from.weight, from.seen);
    else if (to.weight <= 0)
      to.seen = from.seen;
  } else if (from.weight > 0) {
    auto& density = std::get<Somewhere>(to.density);
    const auto& arriving = std::get<Somewhere>(from.density);
    if (!as_it_is || (to.weight > 0 && arriving.footprint() != density.footprint()))
      density.enter(to.weight, from.weight);  // uniform over the other place
    else if (to.weight > 0)
      density = Somewhere::merge(to.weight, density, from.weight, arriving);
    else
      density = arriving;
  }
  to.weight += from.weight;
}

/// About the total variation between two Gaussians over position and velocity, axis by axis: for
/// means d standard deviations apart 0.4 d (2 Phi(d / 2) - 1 for small d), for variances a quarter
/// of their relative difference. Once it is `most` the rest does not count.
double difference(const Kinematic& a, const Kinematic& b, int dims, double most) {
  const auto of = [](double gap, double variance_a, double variance_b) {
    const double sum = variance_a + variance_b;
    return sum > 0 ? 0.4 * std::abs(gap) / std::sqrt(0.5 * sum) +
                         0.5 * std::abs(variance_a - variance_b) / sum
                   : 0.0;
  };
  // Most are so far apart along one axis that of() it is 1, which needs no root to tell.
  for (int i = 0; i < dims; ++i) {
    const double gap = a.position[i] - b.position[i], variances = a.pp(i, i) + b.pp(i, i);
    if (variances > 0 && 0.32 * gap * gap >= variances) return 1;
  }
  double sum = 0;
  for (int i = 0; i < dims && sum < most; ++i)
    sum += of(a.position[i] - b.position[i], a.pp(i, i), b.pp(i, i));
  for (int i = 0; i < dims && sum < most; ++i)
    sum += of(a.velocity[i] - b.velocity[i], a.vv(i, i), b.vv(i, i));
  return std::min(sum, 1.0);
}

}  // namespace

void follow_class(Leaf& leaf, const Background& background) {
  const int top = leaf.top_class();
  if (top == leaf.model_class) return;
  FormerModels former{background.object_class(leaf.model_class).models, {}};
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    const auto* in = std::get_if<Somewhere>(&leaf.models[m].density);
    former.told.push_back(in && in->footprint() != background.footprint(former.models[m].place));
  }
  change_models(leaf, former, top, background);
}

void change_models(Leaf& leaf, const FormerModels& former, int c, const Background& background) {
  const auto& old_models = former.models;
  const auto& models = background.object_class(c).models;
  const auto old = leaf.models;
  const int old_top = leaf.top_model();
  leaf.models.clear();
  const bool lost = old_models[old.size() - 1].implied;
  for (const auto& model : models) {
    if (model.implied && !lost) break;
    if (model.tracked())
      leaf.models.push_back(
          {0, moments(old[old_top], old_models[old_top], model, background.dims)});
    else
      leaf.models.push_back({0, Somewhere(background.footprint(model.place))});
  }
  std::vector<char> taken(models.size(), 0);
  for (std::size_t m = 0; m < old.size(); ++m) {
    const int to = heir(old_models[m], models, taken);
    bool as_it_is = false;
    if (!old_models[m].tracked() && !models[to].tracked())
      as_it_is = former.told[m] || std::get<Somewhere>(old[m].density).footprint() ==
                                       std::get<Somewhere>(leaf.models[to].density).footprint();
    if (old[m].weight > 0 || taken[to])
      take_over(leaf.models[to], old[m], old_models[m], models[to], as_it_is, background.dims);
  }
  leaf.model_class = c;
}

Leaf merge(double weight_a, const Leaf& a, double weight_b, const Leaf& b,
           const Background& background) {
  Leaf out = weight_a >= weight_b ? a : b;
  const double u = weight_a / (weight_a + weight_b), v = 1 - u;
  out.existence = u * a.existence + v * b.existence;
  const double ra = weight_a * a.existence, rb = weight_b * b.existence;
  if (ra + rb <= 0) return out;
  const double wa = ra / (ra + rb), wb = 1 - wa;
  for (std::size_t c = 0; c < out.classes.size(); ++c)
    out.classes[c] = wa * a.classes[c] + wb * b.classes[c];
  for (std::size_t m = 0; m < out.models.size(); ++m) {
    const double ma = wa * a.models[m].weight, mb = wb * b.models[m].weight;
    out.models[m].weight = ma + mb;
    if (ma <= 0 || mb <= 0) {
      const ModelState& only = ma > 0 ? a.models[m] : b.models[m];
      out.models[m].density = only.density;
      out.models[m].seen = only.seen;
    } else if (std::holds_alternative<Kinematic>(a.models[m].density)) {
      out.models[m].density = merge(ma, std::get<Kinematic>(a.models[m].density), mb,
                                    std::get<Kinematic>(b.models[m].density));
      out.models[m].seen = SeenShare::merge(ma, a.models[m].seen, mb, b.models[m].seen);
    } else {
      out.models[m].density = Somewhere::merge(ma, std::get<Somewhere>(a.models[m].density), mb,
                                               std::get<Somewhere>(b.models[m].density));
    }
  }
  for (auto& belief : out.attributes) {
    const auto *in_a = a.attribute(belief.attribute), *in_b = b.attribute(belief.attribute);
    if (!in_a || !in_b) continue;
    for (std::size_t s = 0; s < belief.symbols.size(); ++s)
      belief.symbols[s] = wa * in_a->symbols[s] + wb * in_b->symbols[s];
    const double d = in_b->mean - in_a->mean;
    belief.mean = in_a->mean + wb * d;
    belief.variance = wa * in_a->variance + wb * in_b->variance + wa * wb * d * d;
  }
  out.last_seen = std::max(a.last_seen, b.last_seen);
  follow_class(out, background);
  return out;
}

double difference(const Leaf& a, const Leaf& b, const Background& background, double most) {
  if (a.model_class != b.model_class || a.utime != b.utime || a.held != b.held ||
      a.models.size() != b.models.size() || a.attributes.size() != b.attributes.size())
    return 1;
  double sum = std::abs(a.existence - b.existence);
  for (std::size_t m = 0; m < a.models.size() && sum < most; ++m) {
    const double wa = a.models[m].weight, wb = b.models[m].weight;
    sum += std::abs(wa - wb);
    const auto *ka = std::get_if<Kinematic>(&a.models[m].density),
               *kb = std::get_if<Kinematic>(&b.models[m].density);
    // Whatever their weights: so that of three versions alike in pairs all can be merged.
    if (!ka && std::get<Somewhere>(a.models[m].density).footprint() !=
                   std::get<Somewhere>(b.models[m].density).footprint())
      return 1;
    if (!ka || wa <= 0 || wb <= 0) continue;
    const double w = std::max(wa, wb);
    sum += w * difference(*ka, *kb, background.dims, (most - sum) / w);
    sum += w * SeenShare::difference(a.models[m].seen, b.models[m].seen);
  }
  if (sum >= most) return std::min(sum, 1.0);
  for (std::size_t c = 0; c < a.classes.size(); ++c)
    sum += 0.5 * std::abs(a.classes[c] - b.classes[c]);
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    const AttributeBelief &x = a.attributes[i], &y = b.attributes[i];
    if (x.attribute != y.attribute) return 1;
    for (std::size_t s = 0; s < x.symbols.size(); ++s)
      sum += 0.5 * std::abs(x.symbols[s] - y.symbols[s]);
    if (x.symbols.empty())
      sum += std::abs(x.mean - y.mean) / std::sqrt(x.variance + y.variance) +
             std::abs(std::log(x.variance / y.variance));
  }
  return std::min(sum, 1.0);
}

}  // namespace anchord
