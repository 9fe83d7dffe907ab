#include "anchoring/leaf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "anchoring/shared_detection.h"
#include "core/log_probability.h"

namespace anchord {
namespace {

void move_density(ModelState& state, const BehaviourModel& model, double dt, int dims) {
  auto* kinematic = std::get_if<Kinematic>(&state.density);
  if (!kinematic) {
    if (model.stir > 0) std::get<Somewhere>(state.density).stir(model.stir * dt);
    return;
  }
  if (model.shares())
    predict_shared(*kinematic, model, dt, dims);
  else if (model.kind == BehaviourModel::Kind::kConstantVelocity)
    predict_constant_velocity(*kinematic, model.psd, dt, dims);
  else
    predict_constant_position(*kinematic, model.psd, dt, dims);
}

/// The behaviour weights after the transitions p, and the densities that follow what flows.
template <typename Matrix>
void flow(Leaf& leaf, const Matrix& p, const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  const auto before = leaf.models;
  const int n = static_cast<int>(p.rows());  // a lost model neither gives nor takes
  for (int to = 0; to < n; ++to) {
    double weight = before[to].weight * p(to, to);
    for (int from = 0; from < n; ++from) {
      const double entering = from == to ? 0 : before[from].weight * p(from, to);
      if (entering <= 0) continue;
      if (!models[to].tracked()) {
        std::get<Somewhere>(leaf.models[to].density).enter(weight, entering);
      } else if (models[from].tracked()) {
        auto& density = std::get<Kinematic>(leaf.models[to].density);
        const Kinematic arriving =
            as_model(own_place(std::get<Kinematic>(before[from].density), models[from]), models[to],
                     background.dims);
        SeenShare& seen = leaf.models[to].seen;
        seen = weight > 0 ? SeenShare::merge(weight, seen, entering, before[from].seen)
                          : before[from].seen;
        density = weight > 0 ? merge(weight, density, entering, arriving) : arriving;
      }
      weight += entering;
    }
    leaf.models[to].weight = weight;
  }
}

/// The behaviour weights' Markov chain.
void flow(Leaf& leaf, double dt, const Background& background) {
  const auto& dynamics = background.dynamics[leaf.model_class];
  if (!dynamics.moves || dt == 0) return;
  if (dynamics.rates.rows() <= kFewModels)
    flow(leaf, transition_probabilities(FewModelsMatrix(dynamics.rates), dt), background);
  else
    flow(leaf, transition_probabilities(dynamics.rates, dt), background);
}

/// Attributes change at the rates of the class whose models the leaf has.
void change_attributes(Leaf& leaf, double dt, const Background& background) {
  const auto& changes = background.object_class(leaf.model_class).changes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto belief =
        std::find_if(leaf.attributes.begin(), leaf.attributes.end(),
                     [&](const AttributeBelief& b) { return b.attribute == changes[i].attribute; });
    if (belief == leaf.attributes.end()) continue;
    PoolVector<double>& b = belief->symbols;
    if (b.empty()) {
      belief->variance += changes[i].drift * dt;
    } else if (changes[i].redraw > 0) {
      const double drawn = -std::expm1(-changes[i].redraw * dt);
      for (double& s : b) s += drawn * (1 / static_cast<double>(b.size()) - s);
    } else if (!changes[i].transitions.empty()) {
      const auto& chain = background.dynamics[leaf.model_class].changes[i];
      const ModelMatrix p = transition_probabilities(chain.rates, dt);
      const auto n = static_cast<Eigen::Index>(chain.symbols.size());
      Eigen::RowVectorXd before(n);
      for (Eigen::Index s = 0; s < n; ++s) before[s] = b[chain.symbols[s]];
      const Eigen::RowVectorXd after = before * p;
      for (Eigen::Index s = 0; s < n; ++s) b[chain.symbols[s]] = after[s];
    }
  }
}

/// ln of a model's share in the likelihood of a position, and whether it lies in the model's gate.
struct PositionFit {
  double log_likelihood = kLogZero;
  bool in_gate = false;
};

PositionFit fit_in_place(const Somewhere& somewhere, const MeasuredIn& z, double gate) {
  if (z.mass <= 0) return {};
  return {std::log(somewhere.likelihood(z)), z.mass > 1 - gate};
}

PositionFit position_fit(const ModelState& state, const MapDetection& detection,
                         const Background& background) {
  const Gaussian& z = detection.position;
  const double gate = background.knowledge.limits.gate_probability;
  if (const auto* kinematic = std::get_if<Kinematic>(&state.density)) {
    const Fit f = fit(*kinematic, z, background.dims);
    return {f.log_likelihood, f.distance2 <= background.gate_distance2};
  }
  const auto& somewhere = std::get<Somewhere>(state.density);
  return fit_in_place(somewhere, detection.in(*somewhere.footprint()), gate);
}

/// Whether z may lie in the gate of a model; most detections are too far from most leaves.
bool may_gate(const ModelState& state, const Gaussian& z, const Background& background) {
  const auto* kinematic = std::get_if<Kinematic>(&state.density);
  if (!kinematic) return true;
  // The squared distance over the trace of S is at most Mahalanobis'.
  const double trace = kinematic->pp.trace() + z.covariance.trace();
  return (z.mean - kinematic->position).squaredNorm() <= background.gate_distance2 * trace;
}

double log_attribute_ratio(const Leaf& leaf, const AttributeEvidence& evidence,
                           const Background& background) {
  const AttributeBelief* belief = leaf.attribute(evidence.attribute);
  if (!belief) return 0;
  if (!belief->symbols.empty()) {
    double sum = 0;
    for (std::size_t s = 0; s < belief->symbols.size(); ++s)
      sum += belief->symbols[s] * evidence.ratio[s];
    return std::log(sum);
  }
  const double variance = belief->variance + evidence.variance, d = evidence.mean - belief->mean;
  const auto& attribute = background.knowledge.attributes[evidence.attribute];
  return -0.5 * (d * d / variance + std::log(2 * std::numbers::pi * variance)) -
         std::log(attribute.reference_density);
}

}  // namespace

Kinematic as_model(Kinematic k, const BehaviourModel& model, int dims) {
  if (model.shares()) return shared_place(k, model, dims);
  if (model.kind == BehaviourModel::Kind::kConstantPosition) {
    k.velocity.setZero();
    k.pv.setZero();
    k.vv.setZero();
  } else if (k.vv.isZero(0)) {
    for (int i = 0; i < dims; ++i) k.vv(i, i) = model.initial_velocity_variance[i];
  }
  return k;
}

double real_existence(const Leaf& leaf, const Background& background) {
  if (!background.has_phantoms) return leaf.existence;
  double real = 0;
  for (int c = 0; c < background.classes(); ++c)
    if (!background.object_class(c).phantom) real += leaf.classes[c];
  return leaf.existence * real;
}

Leaf as_real(Leaf leaf, const Background& background) {
  if (!background.has_phantoms) return leaf;
  const double real = real_existence(leaf, background);
  if (real > 0)
    for (int c = 0; c < background.classes(); ++c)
      leaf.classes[c] *= background.object_class(c).phantom ? 0 : leaf.existence / real;
  leaf.existence = real;
  return leaf;
}

int Leaf::top_class() const {
  return static_cast<int>(std::max_element(classes.begin(), classes.end()) - classes.begin());
}

int Leaf::top_model() const {
  int top = -1;
  for (int m = 0; m < static_cast<int>(models.size()); ++m)
    if (std::holds_alternative<Kinematic>(models[m].density) &&
        (top < 0 || models[m].weight > models[top].weight))
      top = m;
  return top;
}

const AttributeBelief* Leaf::attribute(int index) const {
  for (const auto& a : attributes)
    if (a.attribute == index) return &a;
  return nullptr;
}

void predict(Leaf& leaf, Utime utime, const Background& background) {
  const double dt = seconds_between(leaf.utime, utime);
  leaf.utime = utime;
  if (dt == 0) return;
  change_attributes(leaf, dt, background);
  if (leaf.held) return;
  const auto before = leaf.classes;
  double stays = 0;
  bool leaves = false;
  for (int c = 0; c < background.classes(); ++c) {
    const double mu = background.object_class(c).departure_rate;
    if (mu > 0) leaf.classes[c] *= std::exp(-mu * dt), leaves = true;
    stays += leaf.classes[c];
  }
  if (leaves && stays < std::numeric_limits<double>::min()) {
    leaf.existence = 0;  // gone for certain; what it was stays as it was
    leaf.classes = before;
    leaves = false;
  }
  if (leaves) {
    leaf.existence *= stays;
    for (double& b : leaf.classes) b /= stays;
  }
  const auto& models = background.object_class(leaf.model_class).models;
  for (std::size_t m = 0; m < leaf.models.size(); ++m)
    move_density(leaf.models[m], models[m], dt, background.dims);
  flow(leaf, dt, background);
  if (leaves) follow_class(leaf, background);
}

double class_ratio(const Leaf& leaf, const MapDetection& z, int c, const Background& background) {
  if (!z.score || !background.object_class(c).phantom) return z.class_ratio[c];
  return z.class_ratio[c] *
         std::exp(z.score->log_ratio - leaf.scores.log_ratio(*z.score, leaf.utime));
}

double log_likelihood(const Leaf& leaf, const MapDetection& z, const LeafVisibility& shown,
                      bool gated, const Background& background) {
  const double gate = background.knowledge.limits.gate_probability;
  gated = gated && gate < 1;
  const auto& models = background.object_class(leaf.model_class).models;
  const auto counts = [&](std::size_t m) {
    return models[m].detectable && leaf.models[m].weight > 0;
  };
  const auto gates = [&](std::size_t m) { return leaf.models[m].weight > 1 - gate; };
  bool in_gate = !gated;
  for (std::size_t m = 0; m < leaf.models.size() && !in_gate; ++m)
    in_gate = counts(m) && gates(m) && may_gate(leaf.models[m], z.position, background);
  if (!in_gate) return kLogZero;

  in_gate = !gated;
  double log_alone = kLogZero, log_shared = kLogZero;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    if (!counts(m)) continue;
    const PositionFit f = position_fit(leaf.models[m], z, background);
    const double weight = leaf.models[m].weight * shown.factor[m];
    const double log_weight = (weight == 1 ? 0 : std::log(weight)) + f.log_likelihood;
    if (models[m].shares())
      log_shared =
          log_add(log_shared, log_weight + log_shared_ratio(leaf, z, models[m], background));
    else
      log_alone = log_add(log_alone, log_weight);
    in_gate = in_gate || (f.in_gate && gates(m));
  }
  if (!in_gate || (log_alone == kLogZero && log_shared == kLogZero)) return kLogZero;
  double by_class = 0;
  for (std::size_t c = 0; c < leaf.classes.size(); ++c)
    by_class +=
        leaf.classes[c] * z.p_detected[c] * class_ratio(leaf, z, static_cast<int>(c), background);
  double log_g = std::log(by_class) + log_alone;
  for (const auto& evidence : z.attributes)
    log_g += log_attribute_ratio(leaf, evidence, background);
  return log_shared == kLogZero ? log_g : log_add(log_g, std::log(by_class) + log_shared);
}

double log_attribute_ratio(const Leaf& leaf, const MapDetection& z, const Background& background) {
  double sum = 0;
  for (const auto& evidence : z.attributes) sum += log_attribute_ratio(leaf, evidence, background);
  return sum;
}

}  // namespace anchord
