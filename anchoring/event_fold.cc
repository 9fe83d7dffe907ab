#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "anchoring/cluster.h"
#include "anchoring/leading.h"
#include "anchoring/leaf_event.h"
#include "anchoring/map_event.h"
#include "anchoring/naming.h"
#include "core/log_probability.h"

namespace anchord {
namespace {

using Kind = Event::Kind;

/// How many events can be undone: the newest.
constexpr std::size_t kUndoable = 64;

/// What a cluster says of some of its anchors.
std::shared_ptr<const Cluster> only(const Cluster& cluster, const std::vector<int>& anchors,
                                    const Background& background) {
  auto part = std::make_shared<Cluster>();
  for (int a : anchors) part->anchors.push_back(cluster.anchors[a]);
  part->hypotheses = marginal(cluster.hypotheses, anchors);
  choose_leading(*part, background);
  return part;
}

/// Puts a cluster that has changed in the place of an old one, as the independent clusters it
/// consists of, without what none of its worlds holds any more.
void replace(Belief& belief, std::size_t old, const Cluster& changed,
             const Background& background) {
  belief.clusters.erase(old);
  for (auto& part : split(changed, background)) belief.clusters.add(std::move(part), background);
}

/// Takes an anchor out of the belief.
void remove(Belief& belief, const AnchorPlace& at, const Background& background) {
  const auto cluster = belief.clusters[at.cluster];
  std::vector<int> others;
  for (int a = 0; a < static_cast<int>(cluster->anchors.size()); ++a)
    if (a != at.anchor) others.push_back(a);
  if (others.empty())
    belief.clusters.erase(at.cluster);
  else
    replace(belief, at.cluster, *only(*cluster, others, background), background);
}

void set_aside(Belief& belief, SetAside kept) {
  belief.set_aside.push_back(std::move(kept));
  if (belief.set_aside.size() > kUndoable) belief.set_aside.erase(belief.set_aside.begin());
}

/// The leaves of an anchor after something has happened to the object.
template <typename Change>
void change_leaves(AnchorTree& tree, Utime utime, const Background& background, Change change) {
  for (auto& leaf : tree.leaves) {
    auto changed = std::make_shared<Leaf>(*leaf);
    predict(*changed, utime, background);
    change(*changed);
    leaf = std::move(changed);
  }
}

/// Only worlds in which the object exists are left, and in them it does for certain, no phantom.
void exists(Cluster& cluster, int anchor, const Background& background) {
  AnchorTree& tree = cluster.anchors[anchor];
  HypothesisSet left;
  for (const Hypothesis& h : cluster.hypotheses) {
    const int leaf = h.leaf[anchor];
    if (leaf == Hypothesis::kNoLeaf) continue;
    const double p = real_existence(*tree.leaves[leaf], background);
    if (p <= 0) continue;
    left.push_back(h);
    left.back().log_weight += std::log(p);
  }
  if (left.empty())  // it was believed to have left for certain
    for (const Hypothesis& h : cluster.hypotheses)
      if (h.leaf[anchor] != Hypothesis::kNoLeaf) left.push_back(h);
  normalise(left);
  cluster.hypotheses = std::move(left);
  for (auto& leaf : tree.leaves) {
    auto certain = std::make_shared<Leaf>(as_real(*leaf, background));
    certain->existence = 1;
    follow_class(*certain, background);
    leaf = std::move(certain);
  }
}

/// What was done to an object that is held or put somewhere, in every version of it.
void handle(Leaf& leaf, const MapEvent& event, const Background& background) {
  const Kind kind = event.event.kind;
  leaf.held = kind == Kind::kGrasped || kind == Kind::kCarried;
  if (event.at)
    put_at(leaf, *event.at, background);
  else if (!leaf.held && (event.place >= 0 || kind == Kind::kMoved))
    put_somewhere(leaf, event.place, background);
  else if (kind == Kind::kPlaced)
    rest(leaf, background);
}

/// Changes an anchor's leaves where it is; probabilities of worlds stay.
template <typename Change>
void change_anchor(Belief& belief, const AnchorPlace& at, const Background& background,
                   Change change) {
  auto cluster = std::make_shared<Cluster>(*belief.clusters[at.cluster]);
  change_leaves(cluster->anchors[at.anchor], belief.utime, background, change);
  choose_leading(*cluster, background);
  belief.clusters.replace(at.cluster, std::move(cluster), background);
}

/// Grasped, placed or moved: so it exists.
void happen(Belief& belief, const AnchorPlace& at, const MapEvent& event,
            const Background& background) {
  Cluster cluster = *belief.clusters[at.cluster];
  AnchorTree& tree = cluster.anchors[at.anchor];
  change_leaves(tree, belief.utime, background,
                [&](Leaf& leaf) { handle(leaf, event, background); });
  exists(cluster, at.anchor, background);
  Anchor changed = *tree.anchor;
  changed.holder =
      event.event.kind == Kind::kGrasped ? std::optional(event.event.robot) : std::nullopt;
  tree.anchor = std::make_shared<const Anchor>(std::move(changed));
  replace(belief, at.cluster, cluster, background);
}

void give_alias(Belief& belief, const AnchorPlace& at, const std::string& alias,
                const Background& background) {
  auto cluster = std::make_shared<Cluster>(*belief.clusters[at.cluster]);
  Anchor named = *cluster->anchors[at.anchor].anchor;
  named.alias = alias;
  cluster->anchors[at.anchor].anchor = std::make_shared<const Anchor>(std::move(named));
  belief.clusters.replace(at.cluster, std::move(cluster), background);
}

/// Two clusters as one; anchors of the first come first.
Cluster tied(const Cluster& first, const Cluster& second, const Limits& limits) {
  Cluster joint;
  joint.anchors = first.anchors;
  joint.anchors.insert(joint.anchors.end(), second.anchors.begin(), second.anchors.end());
  joint.hypotheses =
      join(first.hypotheses, second.hypotheses, limits.max_hypotheses, limits.min_weight);
  return joint;
}

/// The second anchor's leaves go into the first's tree, fused where a world holds both.
void fuse_trees(Cluster& cluster, int into, int from, Utime utime, const Background& background) {
  AnchorTree& tree = cluster.anchors[into];
  AnchorTree& other = cluster.anchors[from];
  const auto unchanged = [](Leaf&) {};
  change_leaves(tree, utime, background, unchanged);
  change_leaves(other, utime, background, unchanged);
  std::map<std::pair<int, int>, int> fused;
  for (Hypothesis& h : cluster.hypotheses) {
    const int a = h.leaf[into], b = h.leaf[from];
    if (b == Hypothesis::kNoLeaf) continue;
    const auto [it, made] = fused.try_emplace({a, b}, static_cast<int>(tree.leaves.size()));
    if (made)
      tree.leaves.push_back(
          a == Hypothesis::kNoLeaf
              ? other.leaves[b]
              : std::make_shared<const Leaf>(fuse(*tree.leaves[a], *other.leaves[b], background)));
    h.leaf[into] = it->second;
  }
  Anchor one = *tree.anchor;
  if (one.alias.empty()) one.alias = other.anchor->alias;
  if (!one.holder) one.holder = other.anchor->holder;
  tree.anchor = std::make_shared<const Anchor>(std::move(one));
}

void join_anchors(Belief& belief, const MapEvent& event, const AnchorPlace& a, const AnchorPlace& b,
                  const Background& background) {
  const auto first = belief.clusters[a.cluster], second = belief.clusters[b.cluster];
  set_aside(belief, {event.number,
                     {only(*first, {a.anchor}, background), only(*second, {b.anchor}, background)},
                     first->anchors[a.anchor].anchor->birth,
                     std::nullopt});
  const bool one = a.cluster == b.cluster;
  Cluster joint = one ? *first : tied(*first, *second, background.knowledge.limits);
  const int from = one ? b.anchor : b.anchor + static_cast<int>(first->anchors.size());
  fuse_trees(joint, a.anchor, from, belief.utime, background);
  std::vector<int> left;
  for (int i = 0; i < static_cast<int>(joint.anchors.size()); ++i)
    if (i != from) left.push_back(i);
  belief.clusters.replace(a.cluster, only(joint, left, background), background);
  std::size_t at = a.cluster;
  if (!one) {
    belief.clusters.erase(b.cluster);
    at -= b.cluster < a.cluster ? 1 : 0;
  }
  const auto changed = belief.clusters[at];
  replace(belief, at, *changed, background);
}

void undo(Belief& belief, std::int64_t number, const Background& background) {
  const auto it = std::find_if(belief.set_aside.begin(), belief.set_aside.end(),
                               [&](const SetAside& kept) { return kept.number == number; });
  const SetAside kept = *it;
  belief.set_aside.erase(it);
  const auto at = find_anchor(belief, kept.birth);
  if (kept.alias) return give_alias(belief, *at, *kept.alias, background);
  if (at) remove(belief, *at, background);
  for (const auto& cluster : kept.anchors) belief.clusters.add(cluster, background);
}

/// Everything that a robot holds moves with it.
void carry(Belief& belief, const MapEvent& event, const Background& background) {
  for (std::size_t c = 0; c < belief.clusters.size(); ++c)
    for (int a = 0; a < static_cast<int>(belief.clusters[c]->anchors.size()); ++a)
      if (belief.clusters[c]->anchors[a].anchor->holder == event.event.robot)
        change_anchor(belief, {c, a}, background,
                      [&](Leaf& leaf) { handle(leaf, event, background); });
}

void happen_to(Belief& belief, const AnchorPlace& at, const MapEvent& event,
               const Background& background) {
  const Event& e = event.event;
  const Cluster& cluster = *belief.clusters[at.cluster];
  const Anchor& anchor = *cluster.anchors[at.anchor].anchor;
  switch (e.kind) {
    case Kind::kMissing: {
      LookedAt looked_at(event);
      return change_anchor(belief, at, background,
                           [&](Leaf& leaf) { lose(leaf, *event.sensor, looked_at, background); });
    }
    case Kind::kNamed:
      set_aside(belief, {event.number, {}, anchor.birth, anchor.alias});
      return give_alias(belief, at, e.other, background);
    case Kind::kJoined:
      return join_anchors(belief, event, at, *find_anchor(belief, e.other), background);
    case Kind::kDropped:
      set_aside(belief, {event.number, {only(cluster, {at.anchor}, background)}, 0, std::nullopt});
      return remove(belief, at, background);
    case Kind::kRemoved:
      return remove(belief, at, background);
    default:
      return happen(belief, at, event, background);
  }
}

}  // namespace

void fold(Belief& belief, const MapEvent& event, const Background& background) {
  if (!check_against(event, belief)) return;
  if (event.event.kind == Kind::kUndone)
    undo(belief, event.event.undone, background);
  else if (event.event.kind == Kind::kCarried)
    carry(belief, event, background);
  else
    happen_to(belief, *find_anchor(belief, event.event.object), event, background);
  std::vector<std::shared_ptr<const Cluster>> named(belief.clusters.begin(), belief.clusters.end());
  name_anchors(named, belief, background);
  std::vector<std::size_t> changed;
  std::size_t c = 0;
  for (const auto& cluster : belief.clusters) {
    if (named[c] != cluster) changed.push_back(c);
    ++c;
  }
  for (const std::size_t n : changed) belief.clusters.replace(n, named[n], background);
}

}  // namespace anchord
