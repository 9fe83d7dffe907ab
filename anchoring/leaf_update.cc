#include <algorithm>
#include <cmath>

#include "anchoring/leaf.h"
#include "anchoring/shared_detection.h"
#include "anchoring/visibility.h"
#include "core/log_probability.h"

namespace anchord {
namespace {

template <typename Container>
void scale_to_one(Container& values) {
  double sum = 0;
  for (double v : values) sum += v;
  if (sum > 0)
    for (double& v : values) v /= sum;
}

/// Normalises a belief over symbols. What a sensor says in one frame it says again in the next, for
/// the same reasons: many wrong reports are not as many proofs, so none is ruled out.
template <typename Container>
void normalise(Container& symbols, const Background& background) {
  scale_to_one(symbols);
  const double least = background.knowledge.limits.min_symbol;
  if (*std::min_element(symbols.begin(), symbols.end()) >= least) return;
  for (double& s : symbols) s = std::max(s, least);
  scale_to_one(symbols);
}

AttributeBelief first_belief(const AttributeEvidence& evidence, const Background& background) {
  AttributeBelief belief{evidence.attribute,
                         {evidence.ratio.begin(), evidence.ratio.end()},
                         evidence.mean,
                         evidence.variance};
  if (!belief.symbols.empty()) normalise(belief.symbols, background);
  return belief;
}

void learn(AttributeBelief& belief, const AttributeEvidence& evidence,
           const Background& background) {
  if (!belief.symbols.empty()) {
    for (std::size_t s = 0; s < belief.symbols.size(); ++s) belief.symbols[s] *= evidence.ratio[s];
    normalise(belief.symbols, background);
    return;
  }
  const double gain = belief.variance / (belief.variance + evidence.variance);
  belief.mean += gain * (evidence.mean - belief.mean);
  belief.variance *= 1 - gain;
}

/// What is learned if the evidence is about this object, with probability `own`; by moments.
void learn(AttributeBelief& belief, const AttributeEvidence& evidence, double own,
           const Background& background) {
  const AttributeBelief before = belief;
  learn(belief, evidence, background);
  for (std::size_t s = 0; s < belief.symbols.size(); ++s)
    belief.symbols[s] = own * belief.symbols[s] + (1 - own) * before.symbols[s];
  const double gap = belief.mean - before.mean;
  belief.mean = before.mean + own * gap;
  belief.variance =
      own * belief.variance + (1 - own) * before.variance + own * (1 - own) * gap * gap;
}

/// `own`: the probability that what is reported is about this object alone. What it does not hold
/// yet it takes where that is more probable than not.
void learn_attributes(Leaf& leaf, const MapDetection& z, const Background& background,
                      double own = 1) {
  for (const auto& evidence : z.attributes) {
    auto at = std::lower_bound(
        leaf.attributes.begin(), leaf.attributes.end(), evidence.attribute,
        [](const AttributeBelief& b, int attribute) { return b.attribute < attribute; });
    const bool holds = at != leaf.attributes.end() && at->attribute == evidence.attribute;
    if (holds && own < 1)
      learn(*at, evidence, own, background);
    else if (holds)
      learn(*at, evidence, background);
    else if (own >= 0.5)
      leaf.attributes.insert(at, first_belief(evidence, background));
  }
}

/// What was in a `somewhere` has been found at z: it joins a tracked model.
void be_found(Leaf& leaf, std::size_t somewhere, const Gaussian& z, const Sensor& sensor,
              const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  const double weight = leaf.models[somewhere].weight;
  leaf.models[somewhere] = {0, Somewhere(background.footprint(models[somewhere].place))};
  if (weight <= 0) return;
  const int told = models[somewhere].found_in;
  const int target = told >= 0 ? told : background.dynamics[leaf.model_class].first_detectable;
  const bool moving = models[target].kind == BehaviourModel::Kind::kConstantVelocity;
  Kinematic at_z = kinematic_at(z, moving ? models[target].initial_velocity_variance : ByAxis(),
                                background.dims);
  keep_above(at_z, sensor.pose_floor, background.dims);
  ModelState& home = leaf.models[target];
  auto& density = std::get<Kinematic>(home.density);
  density = home.weight > 0 ? merge(home.weight, density, weight, at_z) : at_z;
  home.weight += weight;
}

/// Bayes over the behaviour models. Returns the probability that it did not share the detection.
double update_models(Leaf& leaf, const MapDetection& z, const LeafVisibility& shown,
                     const Sensor& sensor, const Background& background) {
  const int dims = background.dims;
  const auto& models = background.object_class(leaf.model_class).models;
  if (leaf.models.size() == 1 && !models[0].shares())
    if (auto* kinematic = std::get_if<Kinematic>(&leaf.models[0].density)) {
      update(*kinematic, z.position, dims);
      keep_above(*kinematic, sensor.pose_floor, dims);
      leaf.models[0].weight = 1;
      return 1;
    }
  boost::container::small_vector<double, 4> log_weight(leaf.models.size(), kLogZero);
  const double log_own = background.shares ? log_attribute_ratio(leaf, z, background) : 0;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    ModelState& state = leaf.models[m];
    if (!models[m].detectable || state.weight <= 0) continue;
    if (auto* kinematic = std::get_if<Kinematic>(&state.density)) {
      log_weight[m] =
          std::log(state.weight * shown.factor[m]) +
          fit(*kinematic, z.position, dims).log_likelihood +
          (models[m].shares() ? log_shared_ratio(leaf, z, models[m], background) : log_own);
      update(*kinematic, z.position, dims);
      keep_above(*kinematic, sensor.pose_floor, dims);
    } else {
      const auto& somewhere = std::get<Somewhere>(state.density);
      log_weight[m] = std::log(state.weight) +
                      std::log(somewhere.likelihood(z.in(*somewhere.footprint()))) + log_own;
    }
  }
  const double total = log_sum(log_weight, [](double x) { return x; });
  double shared = 0;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    leaf.models[m].weight = std::exp(log_weight[m] - total);
    if (models[m].shares()) shared += leaf.models[m].weight;
  }
  for (std::size_t m = 0; m < leaf.models.size(); ++m)
    if (!models[m].tracked()) be_found(leaf, m, z.position, sensor, background);
  return 1 - shared;
}

}  // namespace

void give(Leaf& leaf, const MapDetection& z, const LeafVisibility& shown, const Sensor& sensor,
          const Background& background) {
  leaf.existence = 1;
  leaf.last_seen = leaf.utime;
  const double own = update_models(leaf, z, shown, sensor, background);
  for (std::size_t c = 0; c < leaf.classes.size(); ++c)
    leaf.classes[c] *= z.p_detected[c] * class_ratio(leaf, z, static_cast<int>(c), background);
  normalise(leaf.classes, background);
  if (z.score) leaf.scores.take(*z.score, leaf.utime);
  learn_attributes(leaf, z, background, own);
  if (z.yaw) leaf.yaw = z.yaw;
  follow_class(leaf, background);
}

void LeafVisibility::average(const Leaf& leaf) {
  if (ranged.empty() || v <= 0) return;
  double sum = 0;
  for (std::size_t m = 0; m < ranged.size(); ++m)
    sum += leaf.models[m].weight * v_model[m] * ranged[m].p;
  p = sum / v;
}

double LeafVisibility::q_of(int c, const Leaf& leaf, const Sensor& sensor) const {
  const DetectionProbability& detected = sensor.detection_probability[c];
  if (ranged.empty() || detected.per_m == 0) return v * detected.near;
  double sum = 0;
  for (std::size_t m = 0; m < ranged.size(); ++m)
    if (v_model[m] > 0) sum += leaf.models[m].weight * v_model[m] * detected.at(ranged[m].range);
  return sum;
}

void give_nothing(Leaf& leaf, const LeafVisibility& shown, const Visibility& visibility,
                  const Sensor& sensor, const Background& background) {
  const double q = shown.q();
  if (q <= 0) return;
  leaf.existence *= (1 - q) / (1 - leaf.existence * q);
  for (std::size_t c = 0; c < leaf.classes.size(); ++c)
    leaf.classes[c] *= (1 - shown.q_of(static_cast<int>(c), leaf, sensor)) / (1 - q);
  normalise(leaf.classes, background);
  double sum = 0;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    ModelState& state = leaf.models[m];
    const double p = shown.p_of(m);
    state.weight *= (1 - p * shown.v_model[m]) / (1 - q);
    sum += state.weight;
    if (shown.v_model[m] <= 0) continue;
    if (auto* somewhere = std::get_if<Somewhere>(&state.density))
      somewhere->miss(p, visibility.of(*somewhere->footprint()));
    else
      state.seen.miss(visibility.aimed(shown.parts[m], std::get<Kinematic>(state.density)),
                      p * shown.v_model[m]);
  }
  for (auto& state : leaf.models) state.weight /= sum;
  follow_class(leaf, background);
}

Leaf first_leaf(const MapDetection& z, std::span<const double> terms, double existence, Utime utime,
                const Background& background, const std::optional<Kinematic>& met) {
  Leaf leaf;
  leaf.existence = existence;
  leaf.classes.assign(terms.begin(), terms.end());
  normalise(leaf.classes, background);
  leaf.model_class = leaf.top_class();
  for (const BehaviourModel& model : background.object_class(leaf.model_class).models) {
    if (model.implied) break;
    if (!model.tracked()) {
      leaf.models.push_back({model.initial_weight, Somewhere(background.footprint(model.place))});
      continue;
    }
    const bool moving = model.kind == BehaviourModel::Kind::kConstantVelocity;
    const Kinematic still = kinematic_at(
        z.position, moving ? model.initial_velocity_variance : ByAxis(), background.dims);
    leaf.models.push_back(
        {model.initial_weight,
         met || model.shares() ? as_model(met.value_or(still), model, background.dims) : still});
  }
  learn_attributes(leaf, z, background);
  leaf.yaw = z.yaw;
  if (z.score) leaf.scores.take(*z.score, utime);
  leaf.utime = leaf.last_seen = utime;
  return leaf;
}

}  // namespace anchord
