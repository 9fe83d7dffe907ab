#include "api/world_line.h"

#include <algorithm>
#include <cmath>

namespace anchord {
namespace {

constexpr double kLeastShown = 0.001;

Json object_json(const ObjectBelief& object, bool all, const Background& background) {
  const int dims = background.dims;
  const Leaf& leaf = object.shown();
  const Kinematic& position = position_of(leaf);
  Json out{{"id", object.anchor->id()},
           {"p", object.p},
           {"position", position_json(position.position, dims)},
           {"covariance", covariance_json(position.pp, dims)},
           {"velocity", position_json(velocity_of(leaf, background), dims)},
           {"attributes", attributes_json(leaf, background)},
           {"models", models_json(leaf, background)},
           {"last_seen", leaf.last_seen}};
  add_shape(out, leaf, background);
  add_said(out, *object.anchor);
  if (all) {
    out["in_best"] = object.in_best;
    const Gaussian marginal = object.moments(background);
    out["marginal"] = {{"position", position_json(marginal.mean, dims)},
                       {"covariance", covariance_json(marginal.covariance, dims)}};
  }
  return out;
}

Json hypotheses_json(const Belief& belief, int count, const Background& background) {
  Json out = Json::array();
  for (const auto& cluster : belief.clusters) {
    Json hypotheses = Json::array();
    for (const Hypothesis& h : cluster->hypotheses) {
      if (static_cast<int>(hypotheses.size()) == count) break;
      Json members = Json::array();
      for (std::size_t a = 0; a < h.leaf.size(); ++a) {
        if (h.leaf[a] == Hypothesis::kNoLeaf) continue;
        Leaf leaf = *cluster->anchors[a].leaves[h.leaf[a]];
        predict(leaf, belief.utime, background);
        members.push_back(
            {{"id", cluster->anchors[a].anchor->id()}, {"p", real_existence(leaf, background)}});
      }
      hypotheses.push_back({{"p", std::exp(h.log_weight)}, {"members", std::move(members)}});
    }
    out.push_back(std::move(hypotheses));
  }
  return out;
}

}  // namespace

Json world_line(const Belief& belief, const Background& background,
                const WorldLineOptions& options) {
  Json objects = Json::array();
  double expected = 0;
  for (const auto& object : read_objects(belief, belief.utime, 0, background)) {
    expected += object.p;
    if (object.in_best || (options.all && object.p >= kLeastShown))
      objects.push_back(object_json(object, options.all, background));
  }
  std::size_t hypotheses = 0;
  for (const auto& cluster : belief.clusters) hypotheses += cluster->hypotheses.size();
  Json line{{"utime", belief.utime},
            {"objects", std::move(objects)},
            {"expected_count", expected},
            {"hypotheses", hypotheses},
            {"clusters", belief.clusters.size()}};
  if (options.hypotheses > 0)
    line["cluster_hypotheses"] = hypotheses_json(belief, options.hypotheses, background);
  if (options.elapsed_us) line["elapsed_us"] = std::round(*options.elapsed_us * 10) / 10;
  return line;
}

}  // namespace anchord
