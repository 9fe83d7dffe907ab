// What a detection says, as the formulas take it.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <variant>

#include "tests/anchoring/enumerated_object.h"

namespace anchord::enumeration {

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

namespace {

/// The attribute `class` without phantoms, as which nothing is reported, and the classes that its
/// symbols are; the sensor's settings likewise.
Attribute reportable(const Knowledge& knowledge, Sensor& sensor, std::vector<int>& classes) {
  const auto a = static_cast<std::size_t>(knowledge.class_attribute);
  Attribute real = knowledge.attributes[a];
  for (std::size_t c = knowledge.classes.size(); c-- > 0;) {
    if (!knowledge.classes[c].phantom) {
      classes.insert(classes.begin(), static_cast<int>(c));
      continue;
    }
    const auto at = static_cast<std::ptrdiff_t>(c);
    real.symbols.erase(real.symbols.begin() + at);
    if (a < sensor.prior.size() && !sensor.prior[a].empty()) {
      auto& prior = sensor.prior[a];
      const double rest = 1 - prior[c];
      for (double& p : prior) p /= rest;
      prior.erase(prior.begin() + at);
    }
    if (a >= sensor.confusion.size() || sensor.confusion[a].empty()) continue;
    auto& rows = sensor.confusion[a];
    rows.erase(rows.begin() + at);
    for (auto& row : rows) row.erase(row.begin() + at);
  }
  return real;
}

/// Of the class: among those that are no phantoms; theirs is that of what they look like, or
/// that of anything.
Eigen::VectorXd reported_class(const SymbolReport& report, const Knowledge& knowledge,
                               Sensor sensor) {
  std::vector<int> classes;
  const Attribute real = reportable(knowledge, sensor, classes);
  const Eigen::VectorXd ratio = symbol_ratio(report, real, sensor, knowledge.class_attribute);
  Eigen::VectorXd all = Eigen::VectorXd::Ones(static_cast<int>(knowledge.classes.size()));
  for (std::size_t i = 0; i < classes.size(); ++i) all(classes[i]) = ratio(i);
  for (int c = 0; c < all.size(); ++c)
    if (knowledge.classes[c].looks_like >= 0) all(c) = all(knowledge.classes[c].looks_like);
  return all;
}

/// The class that is reported as the most probable one.
int label(const SymbolReport& report, const Knowledge& knowledge) {
  Sensor plain;
  std::vector<int> classes;
  const Attribute real = reportable(knowledge, plain, classes);
  Eigen::Index top = 0;
  symbol_ratio(report, real, plain, knowledge.class_attribute).maxCoeff(&top);
  return classes[top];
}

}  // namespace

Measurement measure(const Knowledge& knowledge, const Sensor& sensor, const Detection& detection,
                    const Sight& sight) {
  const int d = knowledge.dims;
  const auto* measured = std::get_if<CartesianMeasurement>(&detection.measurement);
  if (!measured) std::abort();
  const std::vector<double>& r = measured->covariance.empty() ? sensor.noise : measured->covariance;
  Measurement z{.position = Eigen::Map<const Eigen::VectorXd>(measured->position.data(), d),
                .covariance = Eigen::Map<const Eigen::MatrixXd>(r.data(), d, d),
                .range = 0,
                .class_ratio = Eigen::VectorXd::Ones(static_cast<int>(knowledge.classes.size())),
                .symbol_ratio = {},
                .scalar = {},
                .clutter = sensor.clutter_density,
                .log_odds = 0,
                .score = {}};
  if (sight.from) z.position += sight.from->head(d);
  z.range = sight.range(z.position);
  int reported = -1;
  for (const AttributeReport& report : detection.attributes) {
    std::size_t a = 0;
    while (knowledge.attributes.at(a).name != report.name) ++a;
    if (const auto* symbols = std::get_if<SymbolReport>(&report.value)) {
      if (static_cast<int>(a) == knowledge.class_attribute) {
        z.class_ratio = reported_class(*symbols, knowledge, sensor);
        reported = label(*symbols, knowledge);
      } else {
        z.symbol_ratio[static_cast<int>(a)] =
            symbol_ratio(*symbols, knowledge.attributes[a], sensor, a);
      }
    } else {
      z.scalar[static_cast<int>(a)] = std::get<ScalarReport>(report.value);
    }
  }
  if (!sensor.clutter_looks.empty()) {
    double ratio = 0;
    for (int c = 0; c < z.class_ratio.size(); ++c)
      ratio += sensor.clutter_looks[c] * z.class_ratio(c);
    z.clutter *= ratio;
  }
  if (detection.score) {
    const double score = std::clamp(*detection.score, 1e-6, 1 - 1e-6);
    const ScoreCalibration& as = sensor.score_calibration.at(reported);
    const double odds = std::exp(as.a + as.per_m * z.range) * std::pow(score / (1 - score), as.b);
    const double real_share = sensor.real_share.at(reported);
    z.clutter /= odds;
    z.log_odds = std::log(odds);
    z.score = std::log(odds * (1 - real_share) / real_share);
  }
  return z;
}

Eigen::VectorXd detection_probabilities(const Knowledge& knowledge, const Sensor& sensor,
                                        double range) {
  Eigen::VectorXd p(static_cast<int>(knowledge.classes.size()));
  for (int c = 0; c < p.size(); ++c) {
    const DetectionProbability& of = sensor.detection_probability.empty()
                                         ? knowledge.classes[c].detection_probability
                                         : sensor.detection_probability[c];
    p(c) = of.near;
    if (of.per_m == 0) continue;
    const double odds = of.near / (1 - of.near) * std::exp(of.per_m * range);
    p(c) = std::clamp(odds / (1 + odds), 1e-6, 1 - 1e-6);
  }
  return p;
}

}  // namespace anchord::enumeration
