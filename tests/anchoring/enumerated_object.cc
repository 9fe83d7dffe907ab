#include "tests/anchoring/enumerated_object.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace anchord::enumeration {
namespace {

using Kind = BehaviourModel::Kind;

int most_probable(const Eigen::VectorXd& belief) {
  int best = 0;
  for (int i = 1; i < belief.size(); ++i)
    if (belief(i) > belief(best)) best = i;
  return best;
}

/// Index of the first model that satisfies a condition, or -1.
template <typename Condition>
int first(const std::vector<BehaviourModel>& models, Condition holds) {
  const auto found = std::find_if(models.begin(), models.end(), holds);
  return found == models.end() ? -1 : static_cast<int>(found - models.begin());
}
bool is_tracked(const BehaviourModel& m) { return m.tracked(); }
bool is_somewhere(const BehaviourModel& m) { return !m.tracked(); }
bool can_be_found(const BehaviourModel& m) { return m.tracked() && m.detectable && !m.shares(); }

void move(Moments& state, const BehaviourModel& model, int dims, double dt) {
  if (model.kind == Kind::kConstantPosition) {
    for (int i = 0; i < dims; ++i) state.covariance(i, i) += model.psd[i] * dt;
    if (!model.shares()) return;
    Eigen::MatrixXd keep = Eigen::MatrixXd::Identity(2 * dims, 2 * dims);
    const double kept = std::exp(-model.stir * dt);
    keep.bottomRightCorner(dims, dims) *= kept;
    state.mean = (keep * state.mean).eval();
    state.covariance = (keep * state.covariance * keep).eval();
    state.covariance.diagonal().tail(dims).array() += (1 - kept * kept) * model.reach * model.reach;
    return;
  }
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(dims, dims);
  Eigen::MatrixXd f = Eigen::MatrixXd::Identity(2 * dims, 2 * dims), q(2 * dims, 2 * dims);
  Eigen::MatrixXd psd = one;
  for (int i = 0; i < dims; ++i) psd(i, i) = model.psd[i];
  f.topRightCorner(dims, dims) = dt * one;
  q << dt * dt * dt / 3 * psd, dt * dt / 2 * psd, dt * dt / 2 * psd, dt * psd;
  state.mean = (f * state.mean).eval();
  state.covariance = (f * state.covariance * f.transpose() + q).eval();
}

double density_at(const Moments& state, const Measurement& z) {
  const auto d = z.position.size();
  return normal_density(z.position, state.mean.head(d),
                        state.covariance.topLeftCorner(d, d) + z.covariance);
}

void correct(Moments& state, const Measurement& z, int dims) {
  const auto n = state.mean.size();
  const Eigen::MatrixXd h = Eigen::MatrixXd::Identity(dims, n);
  const Eigen::MatrixXd innovation = h * state.covariance * h.transpose() + z.covariance;
  const Eigen::MatrixXd gain = state.covariance * h.transpose() * innovation.inverse();
  state.mean = (state.mean + gain * (z.position - h * state.mean)).eval();
  state.covariance = ((Eigen::MatrixXd::Identity(n, n) - gain * h) * state.covariance).eval();
  state.covariance = ((state.covariance + state.covariance.transpose()) / 2).eval();
}

/// What a detection's size says of an object: 1 everywhere where nothing is known.
struct Sizes {
  double larger = 1;   ///< the probability that it is 1.2 times larger
  double alone = 1;    ///< its density if it is of such an object alone, over its reference
  double at_best = 1;  ///< of all scalars, the most that can be
};

Sizes sizes(const Object& object, const BehaviourModel& model, const Measurement& z,
            const Knowledge& knowledge) {
  const auto held = object.scalars.find(model.growing);
  const auto reported = z.scalar.find(model.growing);
  if (held == object.scalars.end() || reported == z.scalar.end()) return {};
  const ScalarReport own = held->second, seen = reported->second;
  const double reference = knowledge.attributes[model.growing].reference_density;
  const auto bell = [](double gap, double variance) {
    return std::exp(-gap * gap / (2 * variance)) / std::sqrt(2 * std::numbers::pi * variance);
  };
  const double above = seen.mean - 1.2 * own.mean, spread = 1.44 * own.variance + seen.variance;
  double at_best = 1;
  for (const auto& [a, report] : z.scalar)
    if (object.scalars.count(a) > 0)
      at_best *= bell(0, 2 * report.variance) / knowledge.attributes[a].reference_density;
  return {0.5 * (1 + std::erf(above / std::sqrt(2 * spread))),
          bell(seen.mean - own.mean, own.variance + seen.variance) / reference, at_best};
}

double joint_ratio(const Sizes& size) { return size.larger * size.at_best; }

/// How probable it is, for each detection and then for none of them, that an object in a model is
/// hidden there.
std::vector<double> hidden_in(const Object& object, const Moments& state,
                              const BehaviourModel& model,
                              const std::vector<Measurement>& detections,
                              const Knowledge& knowledge) {
  const int dims = knowledge.dims;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(dims);
  std::vector<double> hidden;
  double sum = (1 - model.shared_probability) / model.shared_probability;
  const double nowhere = sum;
  for (const Measurement& z : detections) {
    const Sizes size = sizes(object, model, z, knowledge);
    const Eigen::MatrixXd wide =
        z.covariance + model.reach * model.reach * Eigen::MatrixXd::Identity(dims, dims);
    hidden.push_back(size.larger * std::min(1.0, 1 / size.alone) * density_at(state, z) /
                     normal_density(none, none, wide));
    sum += hidden.back();
  }
  hidden.push_back(nowhere);
  for (double& h : hidden) h /= sum;
  return hidden;
}

/// What is known of attributes fades, or follows their transitions.
void change(Object& object, const AttributeChange& change, double dt) {
  if (const auto scalar = object.scalars.find(change.attribute); scalar != object.scalars.end())
    scalar->second.variance += change.drift * dt;
  const auto held = object.symbols.find(change.attribute);
  if (held == object.symbols.end()) return;
  const auto n = held->second.size();
  Eigen::MatrixXd q = Eigen::MatrixXd::Constant(n, n, change.redraw / static_cast<double>(n));
  for (const Transition& t : change.transitions) q(t.from, t.to) += t.rate;
  q.diagonal() -= q.rowwise().sum();
  held->second = (exponential(q * dt).transpose() * held->second).eval();
}

/// What was learned holds only with a probability; else it is as before.
void doubt_attributes(Object& object, const std::map<int, Eigen::VectorXd>& symbols_before,
                      const std::map<int, ScalarReport>& scalars_before, double own) {
  const auto doubt = [own](auto& now, const auto& before, auto mix) {
    for (auto at = now.begin(); at != now.end();) {
      const auto held = before.find(at->first);
      if (held == before.end() && own < 0.5) {
        at = now.erase(at);
        continue;
      }
      if (held != before.end()) mix(at->second, held->second);
      ++at;
    }
  };
  doubt(object.symbols, symbols_before, [own](Eigen::VectorXd& b, const Eigen::VectorXd& old) {
    b = (own * b + (1 - own) * old).eval();
  });
  doubt(object.scalars, scalars_before, [own](ScalarReport& s, const ScalarReport& old) {
    const double mean = own * s.mean + (1 - own) * old.mean;
    const double square =
        own * (s.variance + s.mean * s.mean) + (1 - own) * (old.variance + old.mean * old.mean);
    s = {mean, square - mean * mean};
  });
}

/// The rate matrix of the behaviour weights: rows leave, columns are entered.
Eigen::MatrixXd rates(const ObjectClass& object_class) {
  const auto& models = object_class.models;
  const auto n = static_cast<Eigen::Index>(models.size());
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      if (models[i].tracked() && !models[j].tracked()) q(i, j) += models[j].rate;
  }
  for (const Transition& t : object_class.transitions) {
    if (!models[t.from].tracked() || !models[t.to].tracked()) std::abort();
    q(t.from, t.to) += t.rate;
  }
  q.diagonal() -= q.rowwise().sum();
  return q;
}

}  // namespace

Eigen::VectorXd symbol_ratio(const SymbolReport& report, const Attribute& attribute,
                             const Sensor& sensor, std::size_t attribute_index) {
  const auto n = static_cast<Eigen::Index>(attribute.symbols.size());
  Eigen::VectorXd m = Eigen::VectorXd::Constant(n, -1);
  double left = 1;
  for (const auto& [symbol, p] : report.probabilities) {
    const auto at = std::find(attribute.symbols.begin(), attribute.symbols.end(), symbol);
    if (at == attribute.symbols.end()) std::abort();
    m(at - attribute.symbols.begin()) = p;
    left -= p;
  }
  const auto unnamed = static_cast<double>((m.array() < 0).count());
  for (double& p : m) p = std::max(p < 0 ? std::max(left, 0.0) / unnamed : p, 1e-6);
  m /= m.sum();

  const std::size_t a = attribute_index;
  if (a < sensor.confusion.size() && !sensor.confusion[a].empty()) {
    Eigen::VectorXd ratio = Eigen::VectorXd::Zero(n);
    for (Eigen::Index s = 0; s < n; ++s)
      for (Eigen::Index j = 0; j < n; ++j) ratio(s) += m(j) * sensor.confusion[a][s][j];
    return ratio / ratio.mean();
  }
  if (a < sensor.prior.size() && !sensor.prior[a].empty()) {
    for (Eigen::Index s = 0; s < n; ++s) m(s) /= sensor.prior[a][s];
    return m;
  }
  return m * static_cast<double>(n);
}

Measurement measure(const Knowledge& knowledge, const Sensor& sensor, const Detection& detection) {
  const int d = knowledge.dims;
  const auto* measured = std::get_if<CartesianMeasurement>(&detection.measurement);
  if (!measured) std::abort();
  const std::vector<double>& r = measured->covariance.empty() ? sensor.noise : measured->covariance;
  Measurement z{.position = Eigen::Map<const Eigen::VectorXd>(measured->position.data(), d),
                .covariance = Eigen::Map<const Eigen::MatrixXd>(r.data(), d, d),
                .class_ratio = Eigen::VectorXd::Ones(static_cast<int>(knowledge.classes.size())),
                .symbol_ratio = {},
                .scalar = {},
                .clutter = sensor.clutter_density};
  for (const AttributeReport& report : detection.attributes) {
    std::size_t a = 0;
    while (knowledge.attributes.at(a).name != report.name) ++a;
    if (const auto* symbols = std::get_if<SymbolReport>(&report.value)) {
      const Eigen::VectorXd ratio = symbol_ratio(*symbols, knowledge.attributes[a], sensor, a);
      if (static_cast<int>(a) == knowledge.class_attribute)
        z.class_ratio = ratio;
      else
        z.symbol_ratio[static_cast<int>(a)] = ratio;
    } else {
      z.scalar[static_cast<int>(a)] = std::get<ScalarReport>(report.value);
    }
  }
  if (detection.score) {
    const double p = std::clamp(*detection.score, 1e-6, 1 - 1e-6);
    z.clutter *= (1 - p) / p;
  }
  return z;
}

Eigen::VectorXd detection_probabilities(const Knowledge& knowledge, const Sensor& sensor) {
  Eigen::VectorXd p(static_cast<int>(knowledge.classes.size()));
  for (int c = 0; c < p.size(); ++c) {
    p(c) = sensor.detection_probability.empty() ? knowledge.classes[c].detection_probability
                                                : sensor.detection_probability[c];
  }
  return p;
}

Laws::Laws(const Knowledge& knowledge) : knowledge_(knowledge), cells_(knowledge) {
  for (int place = -1; place < static_cast<int>(knowledge.places.size()); ++place)
    extents_[place] = extent(knowledge, cells_, place);
}

const std::vector<BehaviourModel>& Laws::models(const Object& object) const {
  return knowledge_.classes[object.object_class].models;
}

double Laws::predict(Object& object, double dt) const {
  for (const AttributeChange& c : knowledge_.classes[object.object_class].changes)
    change(object, c, dt);
  const auto& m = models(object);
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m[i].tracked() && object.models[i].weight > 0)
      move(object.models[i].state, m[i], cells_.dims, dt);
  }
  const Eigen::MatrixXd chain = exponential(rates(knowledge_.classes[object.object_class]) * dt);
  const std::vector<Density> moved = object.models;
  for (std::size_t to = 0; to < m.size(); ++to) {
    Density& density = object.models[to];
    density.weight *= chain(to, to);
    for (std::size_t from = 0; from < m.size(); ++from) {
      const double entering = moved[from].weight * chain(from, to);
      if (from == to || entering == 0) continue;
      if (m[to].tracked()) {
        density.state =
            merge(density.weight, density.state, entering,
                  fit(alone(moved[from].state, m[from], cells_.dims), m[to], cells_.dims));
      } else {
        density.cells = ((density.weight * density.cells + entering * extent_of(m[to]).uniform) /
                         (density.weight + entering))
                            .eval();
      }
      density.weight += entering;
    }
  }
  double leaves = 0;  // exactly 0 where no class ever does
  for (int c = 0; c < object.classes.size(); ++c) {
    const double mu = knowledge_.classes[c].departure_rate;
    leaves -= object.classes(c) * std::expm1(-mu * dt);
    object.classes(c) *= std::exp(-mu * dt);
  }
  object.classes /= object.classes.sum();
  follow_class(object);
  return leaves;
}

double Laws::visible(const Density& density, const BehaviourModel& model,
                     const Sight& sight) const {
  if (!model.detectable || density.weight == 0) return 0;
  if (sight.everything) return 1;
  double mass = 0;
  if (model.tracked()) {
    for (const Rectangle& r : sight.seen)
      mass += probability(density.state.mean.head<2>(),
                          density.state.covariance.topLeftCorner<2, 2>(), r);
  } else {
    for (int i = 0; i < cells_.count(); ++i)
      if (sight.contains(cells_.centre(i))) mass += density.cells(i);
  }
  return mass;
}

double Laws::miss(Object& object, const Sensor& sensor, const Sight& sight,
                  const std::vector<Measurement>& detections) const {
  const auto& m = models(object);
  const Eigen::VectorXd detected = detection_probabilities(knowledge_, sensor);
  const double p = object.classes.dot(detected);
  std::vector<double> v_m;
  double v = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    v_m.push_back(visible(object.models[i], m[i], sight));
    if (m[i].shares() && object.models[i].weight > 0) {
      Moments& state = object.models[i].state;
      const auto hidden = hidden_in(object, state, m[i], detections, knowledge_);
      const double in_view = v_m.back();
      v_m.back() *= hidden.back();
      // Out of view, or missed; then hidden in one or another.
      double weight = 1 - in_view + in_view * hidden.back() * (1 - p);
      Moments sum = state;
      for (std::size_t z = 0; z < detections.size(); ++z) {
        if (in_view * hidden[z] == 0) continue;
        Moments drawn = state;
        correct(drawn, detections[z], cells_.dims);
        sum = merge(weight, sum, in_view * hidden[z], drawn);
        weight += in_view * hidden[z];
      }
      state = sum;
    }
    v += object.models[i].weight * v_m[i];
  }
  const double q = p * v;
  for (int c = 0; c < object.classes.size(); ++c)
    object.classes(c) *= (1 - detected(c) * v) / (1 - q);
  for (std::size_t i = 0; i < m.size(); ++i) {
    Density& density = object.models[i];
    density.weight *= (1 - p * v_m[i]) / (1 - q);
    if (m[i].tracked() || v_m[i] == 0) continue;
    for (int cell = 0; cell < cells_.count(); ++cell)
      if (sight.contains(cells_.centre(cell))) density.cells(cell) *= 1 - p;
    density.cells /= density.cells.sum();
  }
  follow_class(object);
  return 1 - q;
}

double Laws::likelihood(const Density& density, const BehaviourModel& model,
                        const Measurement& z) const {
  if (!model.detectable || density.weight == 0) return 0;
  const int d = cells_.dims;
  if (model.tracked()) return density_at(density.state, z);
  const Extent& e = extent_of(model);
  const int cell = cells_.find(z.position);
  if (cell < 0 || (d == 3 && (z.position(2) < e.floor || z.position(2) > e.ceiling))) return 0;
  return density.cells(cell) / (cells_.edge * cells_.edge * (e.ceiling - e.floor));
}

double Laws::detect(Object& object, const Sensor& sensor, const Measurement& z) const {
  const auto& m = models(object);
  const Eigen::VectorXd classes =
      object.classes.cwiseProduct(detection_probabilities(knowledge_, sensor))
          .cwiseProduct(z.class_ratio);
  std::vector<double> weights;
  double alone = 0, shared = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    weights.push_back(object.models[i].weight * likelihood(object.models[i], m[i], z));
    if (m[i].shares()) weights[i] *= joint_ratio(sizes(object, m[i], z, knowledge_));
    (m[i].shares() ? shared : alone) += weights[i];
  }
  if (classes.sum() * (alone + shared) == 0) return 0;
  // What the attributes say is of it alone, or of others, too.
  double ratio_of_attributes = 1;
  const auto symbols_before = object.symbols;
  const auto scalars_before = object.scalars;
  for (const auto& [a, ratio] : z.symbol_ratio) {
    const auto held = object.symbols.find(a);
    if (held == object.symbols.end()) {
      object.symbols[a] = ratio / ratio.sum();
      continue;
    }
    const Eigen::VectorXd posterior = held->second.cwiseProduct(ratio);
    ratio_of_attributes *= posterior.sum();
    held->second = posterior / posterior.sum();
  }
  for (const auto& [a, report] : z.scalar) {
    const auto [held, first_report] = object.scalars.try_emplace(a, report);
    if (first_report) continue;
    ScalarReport& s = held->second;
    const double variance = s.variance + report.variance;
    ratio_of_attributes *= normal_density(Eigen::VectorXd::Constant(1, report.mean),
                                          Eigen::VectorXd::Constant(1, s.mean),
                                          Eigen::MatrixXd::Constant(1, 1, variance)) /
                           knowledge_.attributes[a].reference_density;
    s = {(s.mean * report.variance + report.mean * s.variance) / variance,
         s.variance * report.variance / variance};
  }

  for (std::size_t i = 0; i < m.size(); ++i)
    if (!m[i].shares()) weights[i] *= ratio_of_attributes;
  alone *= ratio_of_attributes;
  const double place = alone + shared;
  if (shared > 0) doubt_attributes(object, symbols_before, scalars_before, alone / place);

  const int home = first(m, can_be_found);
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m[i].tracked() && weights[i] > 0) correct(object.models[i].state, z, cells_.dims);
    object.models[i].weight = m[i].tracked() ? weights[i] / place : 0;
  }
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m[i].tracked() || weights[i] == 0) continue;  // a `somewhere` that has been found
    Density& found = object.models[home];
    found.state = merge(found.weight, found.state, weights[i] / place,
                        fit({z.position, z.covariance}, m[home], cells_.dims));
    found.weight += weights[i] / place;
  }
  object.classes = classes / classes.sum();
  follow_class(object);
  return classes.sum() * place;
}

Object Laws::born(const Measurement& z, Eigen::VectorXd classes) const {
  Object object;
  object.classes = classes / classes.sum();
  object.object_class = most_probable(object.classes);
  const auto& m = models(object);
  double total = 0;
  for (const BehaviourModel& model : m) total += model.initial_weight;
  for (std::size_t i = 0; i < m.size(); ++i) {
    const double given = total > 0 ? m[i].initial_weight / total : 0;
    Density density{.weight = given, .state = {}, .cells = {}};
    if (m[i].tracked())
      density.state = fit({z.position, z.covariance}, m[i], cells_.dims);
    else
      density.cells = extent_of(m[i]).uniform;
    object.models.push_back(density);
  }
  if (total == 0) object.models[first(m, is_tracked)].weight = 1;
  for (const auto& [a, ratio] : z.symbol_ratio) object.symbols[a] = ratio / ratio.sum();
  object.scalars = z.scalar;
  return object;
}

void Laws::follow_class(Object& object) const {
  const int now = most_probable(object.classes);
  if (now == object.object_class) return;
  const auto& from = models(object);
  const auto& to = knowledge_.classes[now].models;
  std::vector<Density> result(to.size());
  for (std::size_t j = 0; j < to.size(); ++j)
    if (!to[j].tracked()) result[j].cells = extent_of(to[j]).uniform;
  std::vector<bool> taken(to.size(), false);
  std::vector<std::size_t> homeless;
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t j = 0;
    while (j < to.size() &&
           (taken[j] || to[j].kind != from[i].kind || to[j].shares() != from[i].shares() ||
            (!from[i].tracked() && to[j].place != from[i].place)))
      ++j;
    if (j == to.size()) {
      homeless.push_back(i);
    } else {
      taken[j] = true;
      result[j] = object.models[i];
    }
  }
  for (const std::size_t i : homeless) {
    const Density& density = object.models[i];
    if (density.weight == 0) continue;
    const int somewhere = from[i].tracked() ? -1 : first(to, is_somewhere);
    if (somewhere >= 0) {  // what enters a `somewhere` is uniform over its place
      Density& home = result[somewhere];
      home.cells = ((home.weight * home.cells + density.weight * extent_of(to[somewhere]).uniform) /
                    (home.weight + density.weight))
                       .eval();
      home.weight += density.weight;
      continue;
    }
    const int tracked = first(to, is_tracked);
    Density& home = result[tracked];
    const Moments state = from[i].tracked() ? alone(density.state, from[i], cells_.dims)
                                            : moments(density.cells, cells_, extent_of(from[i]));
    home.state =
        merge(home.weight, home.state, density.weight, fit(state, to[tracked], cells_.dims));
    home.weight += density.weight;
  }
  object.models = result;
  object.object_class = now;
}

Moments Laws::position(const Object& object) const {
  const auto& m = models(object);
  Moments total;
  double weight = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    const Density& density = object.models[i];
    if (density.weight == 0) continue;
    const int d = cells_.dims;
    const Moments part = m[i].tracked() ? Moments{density.state.mean.head(d),
                                                  density.state.covariance.topLeftCorner(d, d)}
                                        : moments(density.cells, cells_, extent_of(m[i]));
    total = merge(weight, total, density.weight, part);
    weight += density.weight;
  }
  return total;
}

}  // namespace anchord::enumeration
