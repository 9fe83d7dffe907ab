#include <cmath>
#include <numeric>

#include "anchoring/association.h"
#include "anchoring/naming.h"
#include "core/log_probability.h"

namespace anchord {
namespace {

/// Which clusters and detections belong together: numbers first the clusters, then the detections.
class Ties {
 public:
  explicit Ties(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

struct Group {
  std::vector<PredictedCluster> clusters;
  std::vector<int> detections;
};

double log_gain(const PredictedLeaf& predicted, const Anchor& anchor, const MapDetection& z,
                const Origin& origin, const Sensor& sensor, const Background& background) {
  const bool named = !z.object.empty() && anchor.is_called(z.object);
  const Leaf& leaf = predicted.leaf;
  if (leaf.existence <= 0) return kLogZero;
  const double log_g = log_likelihood(leaf, z, sensor.detection_probability, !named, background);
  if (log_g == kLogZero) return kLogZero;
  double gain = std::log(leaf.existence) - predicted.log_miss - origin.log_weight + log_g;
  if (!z.object.empty() && !named) gain += std::log(sensor.identity_doubt);
  // The world in which z is new or clutter instead outweighs this one by the gain: what lies
  // below min_weight here cannot be above it among all hypotheses.
  return named || gain >= background.log_least_weight ? gain : kLogZero;
}

}  // namespace

std::vector<Origin> origins(const Belief& belief, const MapFrame& frame,
                            const Background& background) {
  std::vector<Origin> out;
  out.reserve(frame.detections.size());
  const double time = belief.seconds(frame.utime);
  for (const MapDetection& z : frame.detections) {
    Origin origin;
    const int cell = background.cell_of(z.position.mean);
    for (int c = 0; c < background.classes(); ++c) {
      origin.terms.push_back(frame.sensor->detection_probability[c] *
                             belief.undetected[c].at(cell, time) * z.class_ratio[c]);
      origin.expected += origin.terms.back();
    }
    const double clutter = std::exp(z.log_clutter);
    origin.existence = origin.expected / (clutter + origin.expected);
    origin.log_weight = std::log(clutter + origin.expected);
    if (!z.object.empty()) origin.log_weight += std::log(frame.sensor->identity_doubt);
    out.push_back(std::move(origin));
  }
  return out;
}

PredictedCluster predict(std::shared_ptr<const Cluster> cluster, const MapFrame& frame,
                         const std::vector<Origin>& origins, const Visibility& visibility,
                         const Background& background) {
  PredictedCluster out;
  out.gated.assign(frame.detections.size(), 0);
  out.leaves.resize(cluster->anchors.size());
  for (std::size_t a = 0; a < cluster->anchors.size(); ++a) {
    out.leaves[a].reserve(cluster->anchors[a].leaves.size());
    for (const auto& leaf : cluster->anchors[a].leaves) {
      PredictedLeaf& predicted = out.leaves[a].emplace_back();
      predicted.leaf = *leaf;
      predict(predicted.leaf, frame.utime, background);
      predicted.shown = visibility.of(predicted.leaf, frame.sensor->detection_probability);
      predicted.log_miss = std::log1p(-predicted.leaf.existence * predicted.shown.q());
      out.shown = out.shown || predicted.shown.q() > 0;
      // Where two steps are not one long one, every frame must be a step.
      out.stepped = out.stepped || background.dynamics[leaf->model_class].exchanges ||
                    predicted.leaf.model_class != leaf->model_class;
      for (std::size_t z = 0; z < frame.detections.size(); ++z) {
        const double gain = log_gain(predicted, *cluster->anchors[a].anchor, frame.detections[z],
                                     origins[z], *frame.sensor, background);
        if (gain == kLogZero) continue;
        predicted.gains.push_back({static_cast<int>(z), gain});
        out.gated[z] = 1;
      }
    }
  }
  out.cluster = std::move(cluster);
  return out;
}

void fold(Belief& belief, const MapFrame& frame, const Visibility& visibility,
          const Background& background) {
  if (belief.frames == 0) belief.start = frame.utime;
  belief.utime = frame.utime;
  ++belief.frames;
  const std::size_t detections = frame.detections.size();
  const auto from = origins(belief, frame, background);

  std::vector<std::shared_ptr<const Cluster>> untouched;
  std::vector<PredictedCluster> touched;
  for (auto& cluster : belief.clusters) {
    auto predicted = predict(cluster, frame, from, visibility, background);
    if (predicted.touched())
      touched.push_back(std::move(predicted));
    else if (!predicted.departed(background.knowledge.limits.min_existence))
      untouched.push_back(std::move(cluster));
  }
  Ties ties(touched.size() + detections);
  for (std::size_t c = 0; c < touched.size(); ++c)
    for (std::size_t z = 0; z < detections; ++z)
      if (touched[c].gated[z]) ties.unite(c, touched.size() + z);

  std::vector<Group> groups(touched.size() + detections);
  for (std::size_t c = 0; c < touched.size(); ++c)
    groups[ties.find(c)].clusters.push_back(std::move(touched[c]));
  for (std::size_t z = 0; z < detections; ++z)
    groups[ties.find(touched.size() + z)].detections.push_back(static_cast<int>(z));

  belief.clusters = std::move(untouched);
  const std::size_t first_touched = belief.clusters.size();
  double log_evidence = -frame.sensor->clutter_density * visibility.volume();
  for (const Group& group : groups) {
    if (group.clusters.empty() && group.detections.empty()) continue;
    for (auto& cluster : associate(group.clusters, group.detections, frame, from, visibility,
                                   background, belief, log_evidence))
      belief.clusters.push_back(std::move(cluster));
  }
  belief.births += detections;
  name_anchors(belief, first_touched, background);
  const double time = belief.seconds(frame.utime);
  for (int c = 0; c < background.classes(); ++c) {
    const double p = frame.sensor->detection_probability[c];
    log_evidence -=
        p * background.cell_volume() * belief.undetected[c].miss(visibility.look(), p, time);
  }
  belief.log_evidence += log_evidence;
}

}  // namespace anchord
