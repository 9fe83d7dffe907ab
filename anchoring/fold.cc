#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "anchoring/association.h"
#include "anchoring/budget.h"
#include "anchoring/concern.h"
#include "anchoring/coupling.h"
#include "anchoring/naming.h"
#include "anchoring/shared_detection.h"
#include "core/log_probability.h"

namespace anchord {
namespace {

double log_gain(const PredictedLeaf& predicted, double log_existence, const Anchor& anchor,
                const MapDetection& z, const Origin& origin, const Sensor& sensor,
                const Background& background) {
  const bool named = !z.object.empty() && anchor.is_called(z.object);
  const Leaf& leaf = predicted.leaf;
  const double log_g = log_likelihood(leaf, z, predicted.shown, !named, background);
  if (log_g == kLogZero) return kLogZero;
  double gain = log_existence - predicted.log_miss - origin.log_weight + log_g;
  if (!z.object.empty() && !named) gain += std::log(sensor.identity_doubt);
  // The world in which z is new or clutter instead outweighs this one by the gain: what lies
  // below min_weight here cannot be above it among all hypotheses.
  return named || gain >= background.log_least_weight ? gain : kLogZero;
}

/// What a detection would be, of the class that is likeliest by an origin's terms, where `moving`
/// has a part in that term; `at_rest` are the terms without it.
std::optional<Kinematic> met_by(const MapDetection& z, const ScratchVector<double>& terms,
                                const ScratchVector<double>& at_rest, const Sensor& sensor,
                                const std::vector<MovingIntensity>& moving,
                                const Background& background) {
  const auto c = std::max_element(terms.begin(), terms.end()) - terms.begin();
  if (terms[c] <= at_rest[c]) return std::nullopt;
  const BehaviourModel& model =
      background.object_class(static_cast<int>(c)).models[background.dynamics[c].first_detectable];
  const Kinematic still =
      kinematic_at(z.position, model.initial_velocity_variance, background.dims);
  Kinematic met =
      moving[c].found_at(z.position, at_rest[c] / (z.p_detected[c] * z.class_ratio[c]), still);
  keep_above(met, sensor.pose_floor, background.dims);
  return met;
}

}  // namespace

ScratchVector<Origin> origins(const Belief& belief, const MapFrame& frame,
                              const Background& background) {
  ScratchVector<Origin> out;
  out.reserve(frame.detections.size());
  const double time = belief.seconds(frame.utime);
  std::vector<MovingIntensity> moving = belief.moving;
  for (MovingIntensity& m : moving) m.advance(time);
  for (int i = 0; i < static_cast<int>(frame.detections.size()); ++i) {
    const MapDetection& z = frame.detections[i];
    Origin origin;
    const int cell = background.cell_of(z.position.mean);
    for (int c = 0; c < background.classes(); ++c)
      origin.terms.push_back(z.p_detected[c] * belief.undetected[c].at(cell, time) *
                             z.class_ratio[c]);
    const ScratchVector<double> at_rest = moving.empty() ? ScratchVector<double>{} : origin.terms;
    for (std::size_t c = 0; c < moving.size(); ++c)
      origin.terms[c] += z.p_detected[c] * moving[c].intensity(z.position) * z.class_ratio[c];
    for (double term : origin.terms) origin.expected += term;
    const double clutter = std::exp(z.log_clutter) + repeat_density(frame, i, background.dims);
    origin.existence = origin.expected / (clutter + origin.expected);
    if (!moving.empty() && origin.existence >= background.knowledge.limits.min_existence)
      origin.met = met_by(z, origin.terms, at_rest, *frame.sensor, moving, background);
    origin.log_weight = std::log(clutter + origin.expected);
    if (!z.object.empty()) origin.log_weight += std::log(frame.sensor->identity_doubt);
    out.push_back(std::move(origin));
  }
  return out;
}

PredictedCluster predict(std::shared_ptr<const Cluster> cluster, const MapFrame& frame,
                         const ScratchVector<Origin>& origins, const Visibility& visibility,
                         const Occlusion& occlusion, Nearby& nearby, const Background& background) {
  PredictedCluster out;
  out.gated.assign(frame.detections.size(), 0);
  out.leaves.resize(cluster->anchors.size());
  for (std::size_t a = 0; a < cluster->anchors.size(); ++a) {
    out.leaves[a].reserve(cluster->anchors[a].leaves.size());
    for (const auto& leaf : cluster->anchors[a].leaves) {
      PredictedLeaf& predicted = out.leaves[a].emplace_back(*leaf);
      predict(predicted.leaf, frame.utime, background);
      predicted.shown = visibility.of(predicted.leaf, *frame.sensor, occlusion,
                                      cluster->anchors[a].anchor->birth);
      if (background.shares) hide(predicted.leaf, frame, background, predicted.shown);
      predicted.log_miss = std::log1p(-predicted.leaf.existence * predicted.shown.q());
      out.shown = out.shown || predicted.shown.q() > 0;
      // Where two steps are not one long one, every frame must be a step.
      out.stepped = out.stepped || background.dynamics[leaf->model_class].exchanges ||
                    predicted.leaf.model_class != leaf->model_class;
      if (predicted.leaf.existence <= 0) continue;
      const double log_existence = std::log(predicted.leaf.existence);
      for (const int z : nearby.to(predicted.leaf)) {
        const double gain = log_gain(predicted, log_existence, *cluster->anchors[a].anchor,
                                     frame.detections[z], origins[z], *frame.sensor, background);
        if (gain == kLogZero) continue;
        predicted.gains.push_back({z, gain});
        out.gated[z] = 1;
      }
    }
  }
  out.cluster = std::move(cluster);
  return out;
}

void fold(Belief& belief, const MapFrame& frame, const Visibility& visibility,
          const Background& background) {
  const Scratch scratch;
  if (belief.frames == 0) belief.start = frame.utime;
  belief.utime = frame.utime;
  ++belief.frames;
  const std::size_t detections = frame.detections.size();
  const auto from = origins(belief, frame, background);
  const Occlusion occlusion(belief, frame, background);

  Nearby nearby(frame, background);
  belief.effort = {};
  const Concern concern(frame, background);
  ScratchVector<PredictedCluster> touched;
  ScratchVector<Clusters::Place> gone;
  belief.clusters.visit(concern, [&](Clusters::Place place, const auto& cluster) {
    auto predicted = predict(cluster, frame, from, visibility, occlusion, nearby, background);
    for (const auto& leaves : predicted.leaves) belief.effort.work += leaves.size();
    if (predicted.touched())
      touched.push_back(std::move(predicted));
    else if (!predicted.departed(background.knowledge.limits.min_existence))
      return;
    gone.push_back(place);
  });
  // Whatever stands next to what.
  std::sort(touched.begin(), touched.end(), [](const auto& a, const auto& b) {
    return a.cluster->anchors[0].anchor->birth < b.cluster->anchors[0].anchor->birth;
  });
  const ScratchVector<Group> groups =
      couple(std::move(touched), static_cast<int>(detections), background.knowledge.limits);

  ScratchVector<std::shared_ptr<const Cluster>> made;
  double log_evidence = -frame.sensor->clutter_density * visibility.volume() -
                        frame.sensor->double_detection * static_cast<double>(detections);
  std::optional<std::uint64_t> left = frame.work;
  if (left) *left -= std::min(*left, belief.effort.work);
  Budget budget(groups, left, background.knowledge.limits);
  for (const Group& group : groups) {
    auto [clusters, log_sum, effort] =
        associate(group.clusters, group.detections, frame, from, visibility, occlusion, background,
                  belief, budget.next());
    std::move(clusters.begin(), clusters.end(), std::back_inserter(made));
    log_evidence += log_sum;
    budget.take(effort.work);
    belief.effort.work += effort.work;
    belief.effort.dropped += effort.dropped;
    belief.effort.cut = belief.effort.cut || effort.cut;
  }
  belief.dropped += belief.effort.dropped;
  belief.cut_frames += belief.effort.cut ? 1 : 0;
  belief.births += detections;
  name_anchors(made, belief, background);
  belief.clusters.exchange(gone, made, background);
  const double time = belief.seconds(frame.utime);
  for (int c = 0; c < background.classes(); ++c) {
    const DetectionProbability& p = frame.sensor->detection_probability[c];
    UndetectedIntensity& lambda = belief.undetected[c];
    const double detected = p.per_m == 0 ? p.near * lambda.miss(visibility.look(), p.near, time)
                                         : lambda.miss(visibility.look(p), 1, time);
    log_evidence -= detected * background.cell_volume();
  }
  for (std::size_t c = 0; c < belief.moving.size() && !frame.view.sees_nothing(); ++c) {
    const DetectionProbability& p = frame.sensor->detection_probability[c];
    belief.moving[c].advance(time);
    log_evidence -= belief.moving[c].miss(
        frame.view, [&](const Eigen::Vector3d& at) { return p.at(visibility.range(at)); });
  }
  belief.log_evidence += log_evidence;
}

}  // namespace anchord
