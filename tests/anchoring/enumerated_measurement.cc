#include <algorithm>
#include <cmath>
#include <cstdlib>

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

}  // namespace anchord::enumeration
