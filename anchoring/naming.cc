#include "anchoring/naming.h"

#include <algorithm>
#include <map>

namespace anchord {
namespace {

bool deserves_name(const Cluster& cluster, int anchor, const Background& background) {
  const Leaf* best = cluster.best_leaf(anchor);
  return (best && real_existence(*best, background) >= kBelievedIn) ||
         cluster.existence(anchor, background) >= kBelievedIn;
}

}  // namespace

void name_anchors(std::span<std::shared_ptr<const Cluster>> clusters, Belief& belief,
                  const Background& background) {
  struct Unnamed {
    std::size_t cluster;
    int anchor;
  };
  std::map<std::uint64_t, Unnamed> in_order;  // by birth
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (int a = 0; a < static_cast<int>(clusters[c]->anchors.size()); ++a) {
      const Anchor& anchor = *clusters[c]->anchors[a].anchor;
      if (anchor.name.empty() && deserves_name(*clusters[c], a, background))
        in_order[anchor.birth] = {c, a};
    }
  for (const auto& [birth, at] : in_order) {
    auto cluster = std::make_shared<Cluster>(*clusters[at.cluster]);
    AnchorTree& tree = cluster->anchors[at.anchor];
    const Leaf* best = cluster->best_leaf(at.anchor);
    const int c = as_real(best ? *best : *tree.leaves.front(), background).top_class();
    Anchor named = *tree.anchor;
    named.name = background.object_class(c).name + "-" + std::to_string(++belief.names[c]);
    tree.anchor = std::make_shared<const Anchor>(std::move(named));
    clusters[at.cluster] = std::move(cluster);
  }
}

}  // namespace anchord
