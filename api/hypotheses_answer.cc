#include <algorithm>
#include <cmath>
#include <optional>

#include "api/answers.h"
#include "mht/hypothesis_set.h"

namespace anchord {
namespace {

/// The best worlds, as the number of a hypothesis for each cluster, with their log-weights.
HypothesisSet best_worlds(const Belief& belief, int limit) {
  HypothesisSet worlds{{0.0, {}}};
  for (const auto& cluster : belief.clusters) {
    HypothesisSet numbers;
    for (std::size_t i = 0; i < cluster->hypotheses.size(); ++i)
      numbers.push_back({cluster->hypotheses[i].log_weight, {static_cast<int>(i)}});
    // join() makes the weights of what it keeps sum to 1: undo that by the best one's.
    const double best = worlds.front().log_weight + numbers.front().log_weight;
    HypothesisSet next = join(worlds, numbers, limit, 0);
    const double shift = best - next.front().log_weight;
    for (auto& world : next) world.log_weight += shift;
    worlds = std::move(next);
  }
  return worlds;
}

/// The anchor's leaf in a hypothesis, as it is now; nothing if it has none.
std::optional<Leaf> leaf_in(const Cluster& cluster, int hypothesis, std::size_t anchor, Utime now,
                            const Background& background) {
  const int number = cluster.hypotheses[hypothesis].leaf[anchor];
  if (number == Hypothesis::kNoLeaf) return std::nullopt;
  Leaf leaf = *cluster.anchors[anchor].leaves[number];
  predict(leaf, now, background);
  return as_real(std::move(leaf), background);
}

bool stands(const std::optional<Leaf>& leaf) { return leaf && leaf->existence >= kBelievedIn; }

/// How an anchor in one world differs from the best one; null if not in a way that shows.
Json difference(const Anchor& anchor, const std::optional<Leaf>& best,
                const std::optional<Leaf>& here, const Background& background) {
  const int dims = background.dims;
  Json out{{"object", anchor.id()}};
  if (stands(best) && !stands(here)) {
    out["change"] = "absent";
    out["best_position"] = position_json(position_of(*best).position, dims);
  } else if (!stands(best) && stands(here)) {
    out["change"] = "present";
    out["position"] = position_json(position_of(*here).position, dims);
  } else if (stands(best) && stands(here)) {
    const bool other_class = best->top_class() != here->top_class();
    const auto gap = fit(position_of(*best), position_of(*here).position_density(), dims);
    if (!other_class && gap.distance2 < 1) return nullptr;
    out["change"] = other_class ? "class" : "moved";
    if (other_class) out["class"] = background.object_class(here->top_class()).name;
    out["position"] = position_json(position_of(*here).position, dims);
    out["best_position"] = position_json(position_of(*best).position, dims);
  } else {
    return nullptr;
  }
  return out;
}

}  // namespace

Result<Json> answer_hypotheses(const HttpTarget& target, const Snapshot& snapshot) {
  const Background& background = *snapshot.background;
  auto asked = read_parameters(target, "limit", background);
  if (!asked) return asked.error();
  const Belief& belief = *snapshot.belief;
  const Utime at = snapshot.utime();
  std::size_t hypotheses = 0;
  for (const auto& cluster : belief.clusters) hypotheses += cluster->hypotheses.size();

  Json worlds = Json::array();
  for (const auto& world : best_worlds(belief, asked->limit)) {
    Json entry{{"p", std::exp(world.log_weight)}};
    if (worlds.empty()) {
      entry["objects"] = Json::array();
      for (const auto& object : read_objects(belief, at, 0, background)) {
        if (!object.in_best) continue;
        const Leaf& leaf = object.versions[object.best].leaf;
        entry["objects"].push_back(
            {{"id", object.anchor->id()},
             {"p", object.p},
             {"class", background.object_class(leaf.top_class()).name},
             {"position", position_json(position_of(leaf).position, background.dims)}});
      }
    }
    entry["differs"] = Json::array();
    for (std::size_t c = 0; c < world.leaf.size(); ++c) {
      if (world.leaf[c] == 0) continue;
      const Cluster& cluster = *belief.clusters[c];
      for (std::size_t a = 0; a < cluster.anchors.size(); ++a) {
        Json d = difference(*cluster.anchors[a].anchor, leaf_in(cluster, 0, a, at, background),
                            leaf_in(cluster, world.leaf[c], a, at, background), background);
        if (!d.is_null()) entry["differs"].push_back(std::move(d));
      }
    }
    // Worlds that differ only in what does not show are one to whoever reads them.
    const auto same = std::find_if(worlds.begin(), worlds.end(), [&](const Json& other) {
      return other["differs"] == entry["differs"];
    });
    if (same == worlds.end())
      worlds.push_back(std::move(entry));
    else
      (*same)["p"] = (*same)["p"].get<double>() + entry["p"].get<double>();
  }
  if (worlds.size() > 1)
    std::stable_sort(worlds.begin() + 1, worlds.end(),
                     [](const Json& a, const Json& b) { return a["p"] > b["p"]; });
  return Json{{"utime", at},
              {"clusters", belief.clusters.size()},
              {"hypotheses", hypotheses},
              {"worlds", std::move(worlds)}};
}

}  // namespace anchord
