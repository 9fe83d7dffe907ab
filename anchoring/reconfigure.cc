#include "anchoring/reconfigure.h"

#include <algorithm>
#include <map>
#include <utility>

#include "anchoring/correspondence.h"
#include "anchoring/in_use.h"

namespace anchord {
namespace {

/// A distribution over what the new knowledge has of the same names; what is new gets nothing yet.
template <typename Container>
Container renamed(const Container& values, const std::vector<int>& to, std::size_t size) {
  bool same = values.size() == size;
  for (std::size_t i = 0; i < to.size() && same; ++i) same = to[i] == static_cast<int>(i);
  if (same) return values;
  Container out(size, 0.0);
  double gone = 0, left = 0;
  for (std::size_t i = 0; i < values.size(); ++i) (to[i] < 0 ? gone : left) += values[i];
  for (std::size_t i = 0; i < values.size(); ++i)
    if (to[i] >= 0) out[to[i]] = gone > 0 ? values[i] / left : values[i];
  return out;
}

/// Carries what is believed from one knowledge to another. Leaves that were shared are.
class Carrier {
 public:
  Carrier(const Correspondence& correspondence, Utime utime) : of_(correspondence), utime_(utime) {}

  std::shared_ptr<const Cluster> operator()(const Cluster& old) {
    auto cluster = std::make_shared<Cluster>(old);
    for (AnchorTree& tree : cluster->anchors)
      for (auto& leaf : tree.leaves) leaf = carried(leaf);
    return cluster;
  }

 private:
  std::shared_ptr<const Leaf> carried(const std::shared_ptr<const Leaf>& old) {
    auto& kept = leaves_[old];
    if (!kept) {
      Leaf leaf = of_.up_to(*old, utime_);
      change(leaf);
      kept = std::make_shared<const Leaf>(std::move(leaf));
    }
    return kept;
  }

  void change(Leaf& leaf) const {
    for (AttributeBelief& belief : leaf.attributes) {
      const auto& symbols = of_.symbols[belief.attribute];
      belief.attribute = of_.attributes[belief.attribute];
      if (!belief.symbols.empty())
        belief.symbols = renamed(belief.symbols, symbols,
                                 of_.to.knowledge.attributes[belief.attribute].symbols.size());
    }
    std::sort(leaf.attributes.begin(), leaf.attributes.end(),
              [](const auto& a, const auto& b) { return a.attribute < b.attribute; });
    const int model_class = leaf.model_class;
    leaf.classes = renamed(leaf.classes, of_.classes, of_.to.knowledge.classes.size());
    change_places(leaf, model_class);
  }

  void change_places(Leaf& leaf, int old_class) const {
    const auto& old_models = of_.from.object_class(old_class).models;
    FormerModels former{of_.models(old_class), {}};
    bool lost = false;  // a place that something is in
    for (std::size_t m = 0; m < leaf.models.size(); ++m) {
      auto* somewhere = std::get_if<Somewhere>(&leaf.models[m].density);
      bool told = false;
      if (somewhere) {
        told = somewhere->footprint() != of_.from.footprint(old_models[m].place);
        const int place = of_.place(of_.from.place_of(*somewhere->footprint()));
        if (place == FormerModels::kNoPlace)
          lost = true, told = false;
        else
          *somewhere = somewhere->over(of_.to.footprint(place));
      }
      former.told.push_back(told);
    }
    const int c = leaf.top_class();
    if (c == of_.classes[old_class] && !lost && stay_in_order(leaf, former, c))
      leaf.model_class = c;
    else
      change_models(leaf, former, c, of_.to);
  }

  /// Whether the leaf's states, as they stand, are of the models of class c.
  bool stay_in_order(const Leaf& leaf, const FormerModels& former, int c) const {
    const auto& models = of_.to.object_class(c).models;
    const auto alike = [](const BehaviourModel& a, const BehaviourModel& b) {
      return a.kind == b.kind && a.place == b.place && a.shares() == b.shares() &&
             a.implied == b.implied;
    };
    const std::size_t held = leaf.models.size();
    return std::equal(former.models.begin(), former.models.begin() + held, models.begin(),
                      models.begin() + std::min(held, models.size()), alike) &&
           (held == models.size() || (held + 1 == models.size() && models[held].implied));
  }

  const Correspondence& of_;
  Utime utime_;
  std::map<std::shared_ptr<const Leaf>, std::shared_ptr<const Leaf>> leaves_;
};

/// An anchor's alias that would look like the name of one.
const Anchor* called_like_a_name(const Cluster& cluster, const Knowledge& knowledge) {
  for (const AnchorTree& tree : cluster.anchors)
    if (looks_like_a_name(tree.anchor->alias, knowledge)) return tree.anchor.get();
  return nullptr;
}

/// Whether the belief can be carried.
Status check(const Belief& belief, const Correspondence& correspondence) {
  const Knowledge &old = correspondence.from.knowledge, &now = correspondence.to.knowledge;
  InUse in_use(correspondence, belief.utime);
  for (const auto& cluster : belief.clusters) in_use.add(*cluster);
  if (Status kept = in_use.check(); !kept) return kept;
  for (std::size_t c = 0; c < old.classes.size(); ++c)
    if (correspondence.classes[c] < 0 && belief.names[c] > 0)
      return Error{ErrorCode::kConflict, "classes." + old.classes[c].name,
                   "cannot be taken away: objects have been named after it, up to " +
                       old.classes[c].name + "-" + std::to_string(belief.names[c]) +
                       ", and names are never used again"};
  for (const auto& cluster : belief.clusters)
    if (const Anchor* anchor = called_like_a_name(*cluster, now))
      return Error{ErrorCode::kConflict,
                   "classes." + anchor->alias.substr(0, anchor->alias.rfind('-')),
                   "cannot be added: " + anchor->id() + " is called '" + anchor->alias +
                       "', as its objects would be"};
  return Done{};
}

/// What can still be undone: what would come back must fit.
bool fits(const SetAside& kept, const Correspondence& correspondence, Utime utime) {
  const Knowledge& now = correspondence.to.knowledge;
  if (kept.alias && looks_like_a_name(*kept.alias, now)) return false;
  InUse in_use(correspondence, utime);
  for (const auto& cluster : kept.anchors) {
    if (called_like_a_name(*cluster, now)) return false;
    in_use.add(*cluster);
  }
  return in_use.check().ok();
}

void carry_undetected(const Belief& old, const Correspondence& of, Belief& belief) {
  const double now = old.seconds(old.utime);
  const bool comparable = of.from.dims == of.to.dims;
  belief.undetected.clear();
  belief.moving.clear();
  for (int c = 0; c < of.to.classes(); ++c) {
    const int before = comparable ? of.former_class(c) : -1;
    belief.undetected.push_back(
        before < 0 ? UndetectedIntensity(of.to.tiling, of.to.arrivals[c], now)
                   : old.undetected[before].continued(of.to.tiling, of.to.arrivals[c], now));
    if (of.to.moving_arrivals.empty()) continue;
    belief.moving.push_back(before < 0 || old.moving.empty()
                                ? MovingIntensity(of.to.moving_arrivals[c], now)
                                : old.moving[before].continued(of.to.moving_arrivals[c], now));
  }
}

}  // namespace

Result<World> reconfigured(const World& world, Knowledge knowledge) {
  return reconfigured(world, World(std::move(knowledge)));
}

Result<World> reconfigured(const World& world, const World& empty) {
  World next = empty;
  const Belief& old = *world.belief();
  const Correspondence correspondence(*world.background(), *next.background());
  if (Status kept = check(old, correspondence); !kept) return kept.error();

  auto belief = std::make_shared<Belief>(old);
  Carrier carry(correspondence, old.utime);
  belief->clusters = old.clusters.changed(
      [&](const Clusters::Pointer& cluster) { return carry(*cluster); }, *next.background());
  std::erase_if(belief->set_aside,
                [&](const SetAside& kept) { return !fits(kept, correspondence, old.utime); });
  for (SetAside& kept : belief->set_aside)
    for (auto& cluster : kept.anchors) cluster = carry(*cluster);
  carry_undetected(old, correspondence, *belief);
  belief->names.assign(next.background()->classes(), 0);
  for (std::size_t c = 0; c < old.names.size(); ++c)
    if (correspondence.classes[c] >= 0) belief->names[correspondence.classes[c]] = old.names[c];

  WorldState state = world.state();
  state.before = std::move(belief);
  state.recent.clear();
  state.floor = old.utime;
  if (Status resumed = next.resume(std::move(state), {}); !resumed) return resumed.error();
  return next;
}

}  // namespace anchord
