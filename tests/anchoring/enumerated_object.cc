#include "tests/anchoring/enumerated_object.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "tests/anchoring/enumerated_sharing.h"

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

void correct(Moments& state, const Measurement& z, int dims) {
  const auto n = state.mean.size();
  const Eigen::MatrixXd h = Eigen::MatrixXd::Identity(dims, n);
  const Eigen::MatrixXd innovation = h * state.covariance * h.transpose() + z.covariance;
  const Eigen::MatrixXd gain = state.covariance * h.transpose() * innovation.inverse();
  state.mean = (state.mean + gain * (z.position - h * state.mean)).eval();
  state.covariance = ((Eigen::MatrixXd::Identity(n, n) - gain * h) * state.covariance).eval();
  state.covariance = ((state.covariance + state.covariance.transpose()) / 2).eval();
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

/// ln f1/f0 of all scores of one thing at once: normal with a distance of 1 between both, and the
/// covariance that the sensor's memory says.
double joint_log_ratio(const std::vector<std::pair<double, double>>& scores,
                       const ScoreMemory& memory) {
  const auto n = static_cast<Eigen::Index>(scores.size());
  Eigen::MatrixXd covariance(n, n);
  Eigen::VectorXd single(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    single(i) = scores[i].second;
    for (Eigen::Index j = 0; j < n; ++j)
      covariance(i, j) =
          i == j ? 1
                 : memory.share *
                       std::exp(-std::abs(scores[i].first - scores[j].first) / memory.seconds);
  }
  return n == 0 ? 0 : covariance.ldlt().solve(single).sum();
}

}  // namespace

Laws::Laws(const Knowledge& knowledge) : knowledge_(knowledge), cells_(knowledge) {
  for (int place = -1; place < static_cast<int>(knowledge.places.size()); ++place)
    extents_[place] = extent(knowledge, cells_, place);
}

const std::vector<BehaviourModel>& Laws::models(const Object& object) const {
  return knowledge_.classes[object.object_class].models;
}

double Laws::predict(Object& object, double dt) const {
  object.age += dt;
  for (const AttributeChange& c : knowledge_.classes[object.object_class].changes)
    change(object, c, dt);
  const auto& m = models(object);
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m[i].tracked() && object.models[i].weight > 0)
      move(object.models[i].state, m[i], cells_.dims, dt);
    if (m[i].tracked()) continue;
    Eigen::VectorXd& cells = object.models[i].cells;
    cells += (1 - std::exp(-m[i].stir * dt)) * (extent_of(m[i]).uniform - cells);
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
        density.looks = density.weight > 0
                            ? merge(density.weight, density.looks, entering, moved[from].looks)
                            : moved[from].looks;
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

double Laws::miss(Object& object, const Sensor& sensor, const Sight& sight,
                  const std::vector<Measurement>& detections) const {
  const auto& m = models(object);
  const Eigen::VectorXd before = object.classes;
  Eigen::VectorXd q_c = Eigen::VectorXd::Zero(before.size());  // detected, if of class c
  std::vector<double> v_m, p_m, mass, deviation;
  for (std::size_t i = 0; i < m.size(); ++i) {
    mass.push_back(visible(object.models[i], m[i], sight));
    deviation.push_back(m[i].tracked() && object.models[i].weight > 0
                            ? spread(object.models[i].state, cells_.dims)
                            : 1);
    v_m.push_back(m[i].tracked() ? object.models[i].looks.at(mass[i], sight.viewer, deviation[i])
                                 : mass[i]);
    const double away = v_m[i] > 0 ? range(object.models[i], m[i], sight) : 0;
    const Eigen::VectorXd detected = detection_probabilities(knowledge_, sensor, away);
    const double p = before.dot(detected);
    p_m.push_back(p);
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
    q_c += object.models[i].weight * v_m[i] * detected;
  }
  const double q = before.dot(q_c);
  for (int c = 0; c < object.classes.size(); ++c) object.classes(c) *= (1 - q_c(c)) / (1 - q);
  for (std::size_t i = 0; i < m.size(); ++i) {
    Density& density = object.models[i];
    density.weight *= (1 - p_m[i] * v_m[i]) / (1 - q);
    if (m[i].tracked()) density.looks.miss(mass[i], p_m[i] * v_m[i], sight.viewer, deviation[i]);
    if (m[i].tracked() || v_m[i] == 0) continue;
    for (int cell = 0; cell < cells_.count(); ++cell)
      if (sight.contains(cells_.centre(cell))) density.cells(cell) *= 1 - p_m[i];
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

double Laws::detect(Object& object, const Sensor& sensor, const Sight& sight,
                    const Measurement& z) const {
  const auto& m = models(object);
  Eigen::VectorXd classes =
      object.classes.cwiseProduct(detection_probabilities(knowledge_, sensor, z.range))
          .cwiseProduct(z.class_ratio);
  if (z.score) {
    const double before = joint_log_ratio(object.scores, sensor.score_memory.rest);
    object.scores.emplace_back(object.age, *z.score);
    const double news = joint_log_ratio(object.scores, sensor.score_memory.rest) - before;
    for (int c = 0; c < classes.size(); ++c)
      if (knowledge_.classes[c].phantom) classes(c) *= std::exp(-news);
  }
  std::vector<double> weights;
  double alone = 0, shared = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    const Density& density = object.models[i];
    weights.push_back(density.weight * likelihood(density, m[i], z));
    const double v = visible(density, m[i], sight);
    if (m[i].tracked() && v > kNothing)
      weights[i] *= density.looks.at(v, sight.viewer, spread(density.state, cells_.dims)) / v;
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
    const int to = m[i].found_in < 0 ? home : m[i].found_in;
    Density& found = object.models[to];
    found.state = merge(found.weight, found.state, weights[i] / place,
                        fit({z.position, z.covariance}, m[to], cells_.dims));
    found.weight += weights[i] / place;
  }
  object.classes = classes / classes.sum();
  follow_class(object);
  find(object, sight);
  return classes.sum() * place;
}

Object Laws::born(const Measurement& z, const Sight& sight, Eigen::VectorXd classes) const {
  Object object;
  if (z.score) object.scores.emplace_back(0, *z.score);
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
  find(object, sight);
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
    home.looks = home.weight > 0 ? merge(home.weight, home.looks, density.weight, density.looks)
                                 : density.looks;
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
