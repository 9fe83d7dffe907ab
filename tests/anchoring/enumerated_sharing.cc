#include "tests/anchoring/enumerated_sharing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace anchord::enumeration {

double density_at(const Moments& state, const Measurement& z) {
  const auto d = z.position.size();
  return normal_density(z.position, state.mean.head(d),
                        state.covariance.topLeftCorner(d, d) + z.covariance);
}

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

}  // namespace anchord::enumeration
