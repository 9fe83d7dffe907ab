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

/// Of the class: among those that are no phantoms; theirs is clutter's own.
Eigen::VectorXd reported_class(const SymbolReport& report, const Knowledge& knowledge,
                               Sensor sensor) {
  const auto a = static_cast<std::size_t>(knowledge.class_attribute);
  Attribute real = knowledge.attributes[a];
  for (std::size_t c = knowledge.classes.size(); c-- > 0;) {
    if (!knowledge.classes[c].phantom) continue;
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
  const Eigen::VectorXd ratio = symbol_ratio(report, real, sensor, a);
  Eigen::VectorXd all = Eigen::VectorXd::Ones(static_cast<int>(knowledge.classes.size()));
  int next = 0;
  for (int c = 0; c < all.size(); ++c)
    if (!knowledge.classes[c].phantom) all(c) = ratio(next++);
  return all;
}

}  // namespace

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
                .clutter = sensor.clutter_density,
                .score = {}};
  for (const AttributeReport& report : detection.attributes) {
    std::size_t a = 0;
    while (knowledge.attributes.at(a).name != report.name) ++a;
    if (const auto* symbols = std::get_if<SymbolReport>(&report.value)) {
      if (static_cast<int>(a) == knowledge.class_attribute)
        z.class_ratio = reported_class(*symbols, knowledge, sensor);
      else
        z.symbol_ratio[static_cast<int>(a)] =
            symbol_ratio(*symbols, knowledge.attributes[a], sensor, a);
    } else {
      z.scalar[static_cast<int>(a)] = std::get<ScalarReport>(report.value);
    }
  }
  if (detection.score) {
    const double p = std::clamp(*detection.score, 1e-6, 1 - 1e-6);
    z.clutter *= (1 - p) / p;
    z.score = std::log(p / (1 - p) * (1 - sensor.real_share) / sensor.real_share);
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

}  // namespace anchord::enumeration
