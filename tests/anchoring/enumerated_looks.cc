// What looks tell of an object that is in view in part.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/anchoring/enumerated_object.h"

namespace anchord::enumeration {

double spread(const Moments& state, int dims) {
  return std::pow(state.covariance.topLeftCorner(dims, dims).determinant(), 0.5 / dims);
}

double Looks::at(double v) const {
  std::pair<double, double> below(0, 0), above(1, 1);
  for (const auto& [edge, s] : share) {
    if (edge < v) below = {edge, s};
    if (edge >= v && edge < above.first) above = {edge, s};
  }
  const auto [v0, s0] = below;
  const auto [v1, s1] = above;
  return v1 == v0 ? s1 : s0 + (s1 - s0) * (v - v0) / (v1 - v0);
}

double Looks::at(double v, const std::string& by, double deviation_now) const {
  if (by != viewer || v <= kNothing || v >= 1 - kNothing) return v;
  return v + std::min(1.0, deviation / deviation_now) * (at(v) - v);
}

void Looks::miss(double v, double lost, const std::string& by, double deviation_now) {
  if (v <= kNothing || lost == 0) return;
  if (by != viewer || v >= 1 - kNothing) share.clear();
  if (v >= 1 - kNothing) return;
  const double kept = std::min(1.0, deviation / deviation_now);
  for (auto& [edge, s] : share) s = edge + kept * (s - edge);
  viewer = by;
  deviation = deviation_now;
  const double before = share[v] = at(v);
  for (auto& [edge, s] : share) s = (s - lost * (edge <= v ? s / before : 1)) / (1 - lost);
}

Looks merge(double weight_a, const Looks& a, double weight_b, const Looks& b) {
  if (weight_a < weight_b) return merge(weight_b, b, weight_a, a);
  if (!a.share.empty() && !b.share.empty() && a.viewer != b.viewer)
    return merge(weight_a, a, weight_b, Looks());
  Looks out = a.share.empty() ? b : a;
  const double wa = weight_a / (weight_a + weight_b);
  if (!a.share.empty() && !b.share.empty())
    out.deviation =
        std::sqrt(wa * a.deviation * a.deviation + (1 - wa) * b.deviation * b.deviation);
  for (const Looks* looks : {&a, &b})
    for (const auto& [v, s] : looks->share) out.share[v] = wa * a.at(v) + (1 - wa) * b.at(v);
  return out;
}

double Laws::visible(const Density& density, const BehaviourModel& model,
                     const Sight& sight) const {
  return model.detectable && density.weight > 0 ? mass_in_view(density, model, sight) : 0;
}

double Laws::mass_in_view(const Density& density, const BehaviourModel& model,
                          const Sight& sight) const {
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

void Laws::find(Object& object, const Sight& sight) const {
  const auto& m = models(object);
  for (std::size_t i = 0; i < m.size(); ++i) {
    Density& density = object.models[i];
    if (!m[i].tracked() || density.weight == 0) continue;
    density.looks = {sight.viewer, spread(density.state, cells_.dims), {}};
    const double v = mass_in_view(density, m[i], sight);
    if (v >= 1e-3 && v < 1 - kNothing) density.looks.share[v] = 1;
  }
}

double Laws::range(const Density& density, const BehaviourModel& model, const Sight& sight) const {
  if (model.tracked()) return sight.range(density.state.mean.head(cells_.dims));
  const Extent& e = extent_of(model);
  double sum = 0, seen = 0;
  for (int i = 0; i < cells_.count(); ++i) {
    if (e.uniform(i) == 0 || !(sight.everything || sight.contains(cells_.centre(i)))) continue;
    sum += cells_.range(i, e.floor, e.ceiling, sight);
    ++seen;
  }
  return sum / seen;
}

}  // namespace anchord::enumeration
