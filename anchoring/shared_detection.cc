#include "anchoring/shared_detection.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/log_probability.h"

namespace anchord {
namespace {

/// Beyond this squared distance, in variances, nothing is hidden that a double could tell: e^-40.
constexpr double kOutOfReach2 = 80;

/// Of two objects that touch or overlap, the joint extent is larger than each by about this much.
constexpr double kLarger = 1.2;

double root_determinant(const Eigen::Matrix3d& m, int dims) {
  return std::sqrt(dims == 2 ? m.topLeftCorner<2, 2>().determinant() : m.determinant());
}

/// How near a detection is to where the one that an object shares should be: its density there,
/// over that of one just there of which only the reach is known.
double nearness(const Kinematic& place, const Gaussian& z, double reach, int dims) {
  const double trace = place.pp.trace() + z.covariance.trace();
  if ((z.mean - place.position).squaredNorm() > kOutOfReach2 * trace) return 0;
  const Eigen::Matrix3d wide = z.covariance + reach * reach * Eigen::Matrix3d::Identity();
  return std::exp(fit(place, z, dims).log_likelihood) * root_determinant(wide, dims) *
         std::pow(2 * std::numbers::pi, 0.5 * dims);
}

double normal_ratio(double gap, double variance, const Attribute& attribute) {
  return std::exp(-0.5 * gap * gap / variance) /
         (std::sqrt(2 * std::numbers::pi * variance) * attribute.reference_density);
}

/// A detection's size, beside a leaf's.
struct SizeFit {
  double larger;  ///< the probability that it is larger as a joint extent is
  double alone;   ///< its L_A, if it is of such an object alone
};

std::optional<SizeFit> size_fit(const Leaf& leaf, const MapDetection& z,
                                const BehaviourModel& model, const Background& background) {
  const AttributeBelief* belief = model.growing < 0 ? nullptr : leaf.attribute(model.growing);
  if (!belief) return std::nullopt;
  for (const AttributeEvidence& evidence : z.attributes) {
    if (evidence.attribute != model.growing) continue;
    const double above = evidence.mean - kLarger * belief->mean;
    const double spread = kLarger * kLarger * belief->variance + evidence.variance;
    const double gap = evidence.mean - belief->mean,
                 variance = belief->variance + evidence.variance;
    return SizeFit{0.5 * std::erfc(-above / std::sqrt(2 * spread)),
                   normal_ratio(gap, variance, background.knowledge.attributes[model.growing])};
  }
  return std::nullopt;
}

/// How probable it is, by its size, that a detection is of more than one object, one of them like
/// this: over that it is of another that is like this and alone.
double host_ratio(const Leaf& leaf, const MapDetection& z, const BehaviourModel& model,
                  const Background& background) {
  const auto fit = size_fit(leaf, z, model, background);
  return fit ? fit->larger * std::min(1.0, 1 / fit->alone) : 1;
}

struct Hosts {
  std::vector<double> hidden;  ///< per detection: the probability of being in it
  double total = 0;
};

/// Where an object in a sharing model is, of those detections that are near. `alone`: what stands
/// for none of them; the model's probability is that of being hidden in one that is just there.
Hosts hosts_of(const Leaf& leaf, const Kinematic& density, const BehaviourModel& model,
               const MapFrame& frame, const Background& background) {
  const double alone = (1 - model.shared_probability) / model.shared_probability;
  Hosts hosts;
  for (const MapDetection& z : frame.detections) {
    double near = nearness(density, z.position, model.reach, background.dims);
    if (near > 0) near *= host_ratio(leaf, z, model, background);
    hosts.total += hosts.hidden.emplace_back(near);
  }
  const double all = hosts.total + alone;
  for (double& h : hosts.hidden) h /= all;
  hosts.total /= all;
  return hosts;
}

bool may_hide(const ModelState& state, const BehaviourModel& model) {
  return model.shares() && state.weight > 0;
}

}  // namespace

Kinematic own_place(Kinematic density, const BehaviourModel& model) {
  if (!model.shares()) return density;
  density.position += density.velocity;
  density.pp += density.pv + density.pv.transpose() + density.vv;
  density.velocity.setZero();
  density.pv.setZero();
  density.vv.setZero();
  return density;
}

Kinematic shared_place(Kinematic density, const BehaviourModel& model, int dims) {
  density.velocity.setZero();
  density.vv.setZero();
  for (int i = 0; i < dims; ++i) density.vv(i, i) = model.reach * model.reach;
  density.pv = -density.vv;
  density.pp += density.vv;
  return density;
}

void predict_shared(Kinematic& density, const BehaviourModel& model, double dt, int dims) {
  predict_constant_position(density, model.psd, dt, dims);
  const double kept = std::exp(-model.stir * dt);
  density.velocity *= kept;
  density.pv *= kept;
  density.vv *= kept * kept;
  for (int i = 0; i < dims; ++i) density.vv(i, i) += (1 - kept * kept) * model.reach * model.reach;
}

double log_shared_ratio(const Leaf& leaf, const MapDetection& z, const BehaviourModel& model,
                        const Background& background) {
  const auto fit = size_fit(leaf, z, model, background);
  if (!fit) return 0;
  double ratio = fit->larger;
  for (const AttributeEvidence& evidence : z.attributes)
    if (const auto* belief = leaf.attribute(evidence.attribute); belief && belief->symbols.empty())
      ratio *= normal_ratio(0, 2 * evidence.variance,
                            background.knowledge.attributes[evidence.attribute]);
  return std::log(ratio);
}

void hide(const Leaf& leaf, const MapFrame& frame, const Background& background,
          LeafVisibility& shown) {
  const auto& models = background.object_class(leaf.model_class).models;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    double& v = shown.v_model[m];
    if (!may_hide(leaf.models[m], models[m]) || v <= 0) continue;
    const auto& density = std::get<Kinematic>(leaf.models[m].density);
    const double hidden = v * hosts_of(leaf, density, models[m], frame, background).total;
    v -= hidden;
    shown.v -= leaf.models[m].weight * hidden;
  }
  shown.average(leaf);
}

int draw_to_hosts(Leaf& leaf, const MapFrame& frame, const LeafVisibility& shown,
                  const Background& background) {
  const auto& models = background.object_class(leaf.model_class).models;
  int in = -1;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    if (!may_hide(leaf.models[m], models[m]) || shown.v_model[m] <= 0) continue;
    auto& density = std::get<Kinematic>(leaf.models[m].density);
    const Hosts hosts = hosts_of(leaf, density, models[m], frame, background);
    const double in_view = shown.v_model[m] / (1 - hosts.total);
    // Out of view, or missed like any other.
    double weight = 1 - in_view * hosts.total - shown.p_of(m) * shown.v_model[m];
    const Kinematic before = density;
    for (std::size_t z = 0; z < hosts.hidden.size(); ++z) {
      const double hidden = in_view * hosts.hidden[z];
      if (hidden <= 0) continue;
      Kinematic drawn = before;
      update(drawn, frame.detections[z].position, background.dims);
      density = merge(weight, density, hidden, drawn);
      weight += hidden;
      if (leaf.models[m].weight * hidden > 0.5) in = static_cast<int>(z);
    }
  }
  return in;
}

double repeat_density(const MapFrame& frame, int z, int dims) {
  const double often = frame.sensor->double_detection;
  if (often <= 0) return 0;
  const Gaussian& place = frame.detections[z].position;
  const double sure = frame.detections[z].log_odds.value_or(0);
  double sum = 0;
  for (int first = 0; first < static_cast<int>(frame.detections.size()); ++first) {
    const double surer = frame.detections[first].log_odds.value_or(0);
    if (surer < sure || (surer == sure && first >= z)) continue;
    Kinematic at;
    at.position = frame.detections[first].position.mean;
    at.pp = frame.detections[first].position.covariance;
    sum += std::exp(fit(at, place, dims).log_likelihood);
  }
  return often * sum;
}

}  // namespace anchord
