#include "experiments/anchoring/watching.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "anchoring/reading.h"

namespace anchord::experiment {

void take(World& world, const Frame& frame) {
  const Status status = world.apply(frame);
  if (status.ok()) return;
  std::fprintf(stderr, "the engine refused a frame: %s\n", status.error().text().c_str());
  std::abort();
}

std::vector<Shown> best_world(const Belief& belief) {
  std::vector<Shown> shown;
  for (const auto& cluster : belief.clusters)
    for (std::size_t a = 0; a < cluster->anchors.size(); ++a) {
      const Leaf* leaf = cluster->best_leaf(static_cast<int>(a));
      if (!leaf || leaf->existence < kBelievedIn) continue;
      shown.push_back(
          {cluster->anchors[a].anchor->birth, position_of(*leaf).position.head<2>(), leaf});
    }
  return shown;
}

const Shown* nearest(const std::vector<Shown>& shown, const Eigen::Vector2d& place, double radius) {
  const Shown* best = nullptr;
  for (const Shown& s : shown) {
    const double distance = (s.position - place).norm();
    if (distance <= radius && (!best || distance < (best->position - place).norm())) best = &s;
  }
  return best;
}

double probability_of(const Belief& belief, const std::vector<Standing>& all, double radius) {
  double p = 1;  // clusters are independent
  std::size_t found = 0;
  for (const auto& cluster : belief.clusters) {
    std::vector<std::pair<std::size_t, const Standing*>> here;
    for (std::size_t a = 0; a < cluster->anchors.size(); ++a)
      for (const Standing& standing : all)
        if (cluster->anchors[a].anchor->birth == standing.birth) here.emplace_back(a, &standing);
    if (here.empty()) continue;
    found += here.size();
    double in_cluster = 0;
    for (const Hypothesis& h : cluster->hypotheses) {
      double holds = std::exp(h.log_weight);
      for (const auto& [a, standing] : here) {
        const Leaf* leaf = h.leaf[a] == Hypothesis::kNoLeaf
                               ? nullptr
                               : cluster->anchors[a].leaves[h.leaf[a]].get();
        const bool there =
            leaf && (position_of(*leaf).position.head<2>() - standing->place).norm() <= radius;
        holds *= there ? leaf->existence : 0;
      }
      in_cluster += holds;
    }
    p *= in_cluster;
  }
  return found == all.size() ? p : 0;
}

std::vector<std::uint64_t> anchors(const Belief& belief) {
  std::vector<std::uint64_t> births;
  for (const auto& cluster : belief.clusters)
    for (const AnchorTree& tree : cluster->anchors) births.push_back(tree.anchor->birth);
  return births;
}

}  // namespace anchord::experiment
