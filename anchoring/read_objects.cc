#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "anchoring/reading.h"

namespace anchord {
namespace {

/// The objects of a cluster.
class Objects {
 public:
  Objects(const Cluster& cluster, Utime at, const Background& background) : cluster_(cluster) {
    const Hypothesis& shown = cluster.hypotheses[cluster.leading];
    for (std::size_t a = 0; a < cluster.anchors.size(); ++a) {
      ObjectBelief& object = objects_.emplace_back();
      object.anchor = cluster.anchors[a].anchor;
      for (const auto& leaf : cluster.anchors[a].leaves)
        object.versions.push_back({0, leaf_at(*leaf, at, background)});
      object.best = shown.leaf[a];
      object.in_best = object.best >= 0 && stands(a, object.best);
      if (object.in_best)
        for (const std::uint64_t detection : cluster.anchors[a].leaves[object.best]->recent)
          shown_.emplace(detection, a);
    }
    for (const Hypothesis& h : cluster.hypotheses) add(h);
    for (ObjectBelief& object : objects_) {
      leave_out_the_improbable(object);
      for (const auto& version : object.versions)
        object.p += version.probability * version.leaf.existence;
      object.p = std::min(object.p, 1.0);  // sums of rounded weights
    }
  }

  std::vector<ObjectBelief>& all() { return objects_; }

 private:
  /// A version of an anchor's that another object is in some hypothesis, and where it is among that
  /// object's versions.
  struct Other {
    std::size_t object, anchor;
    int leaf;
    std::size_t version;
  };

  /// Versions that are in no hypothesis what the object is.
  static void leave_out_the_improbable(ObjectBelief& object) {
    std::size_t kept = 0;
    int best = -1;
    for (std::size_t v = 0; v < object.versions.size(); ++v) {
      const bool shown = static_cast<int>(v) == object.best;
      if (!shown && object.versions[v].probability <= 0) continue;
      if (shown) best = static_cast<int>(kept);
      if (kept != v) object.versions[kept] = std::move(object.versions[v]);
      ++kept;
    }
    object.versions.resize(kept);
    object.best = best;
  }

  bool stands(std::size_t anchor, int leaf) const {
    return leaf != Hypothesis::kNoLeaf &&
           objects_[anchor].versions[leaf].leaf.existence >= kBelievedIn;
  }

  void add(const Hypothesis& h) {
    meant_.resize(h.leaf.size());
    std::iota(meant_.begin(), meant_.end(), std::size_t{0});
    for (std::size_t a = 0; a < h.leaf.size() && !shown_.empty(); ++a)
      if (!objects_[a].in_best && stands(a, h.leaf[a])) mean_a_shown(h, a);
    const double p = std::exp(h.log_weight);
    for (std::size_t a = 0; a < h.leaf.size(); ++a)
      if (h.leaf[a] != Hypothesis::kNoLeaf) version(meant_[a], a, h.leaf[a]).probability += p;
  }

  /// An anchor is in a hypothesis a shown object that is not there itself, if they had a detection
  /// in common; or if it had one in common with a shown object that is there, and that one with it,
  /// and so on: then who is who of them all is open, but not how many they are.
  void mean_a_shown(const Hypothesis& h, std::size_t anchor) {
    asked_.assign(h.leaf.size(), 0);
    asked_[anchor] = 1;
    queue_.assign(1, anchor);
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const std::size_t one = queue_[next];
      const auto& recent = cluster_.anchors[one].leaves[h.leaf[one]]->recent;
      for (auto detection = recent.rbegin(); detection != recent.rend(); ++detection) {
        const auto [first, end] = shown_.equal_range(*detection);
        for (auto it = first; it != end; ++it) {
          const std::size_t shown = it->second;
          if (asked_[shown]) continue;
          asked_[shown] = 1;
          if (stands(shown, h.leaf[shown])) {
            queue_.push_back(shown);
          } else if (meant_[shown] == shown) {
            std::swap(meant_[shown], meant_[anchor]);
            return;
          }
        }
      }
    }
  }

  ObjectBelief::Version& version(std::size_t object, std::size_t anchor, int leaf) {
    auto& versions = objects_[object].versions;
    if (object == anchor) return versions[leaf];
    auto other = std::find_if(others_.begin(), others_.end(), [&](const Other& o) {
      return o.object == object && o.anchor == anchor && o.leaf == leaf;
    });
    if (other == others_.end()) {
      other = others_.insert(others_.end(), {object, anchor, leaf, versions.size()});
      versions.push_back({0, objects_[anchor].versions[leaf].leaf});
    }
    return versions[other->version];
  }

  const Cluster& cluster_;
  std::vector<ObjectBelief> objects_;  ///< as the cluster's anchors
  /// Objects of the best world by their last detections.
  std::multimap<std::uint64_t, std::size_t> shown_;
  std::vector<std::size_t> meant_;  ///< per anchor of the hypothesis at hand: the object that it is
  std::vector<Other> others_;
  std::vector<std::size_t> queue_;  ///< of mean_a_shown()
  std::vector<char> asked_;
};

}  // namespace

Leaf leaf_at(const Leaf& leaf, Utime at, const Background& background) {
  Leaf out = leaf;
  if (at > leaf.utime) predict(out, at, background);
  for (ModelState& state : out.models)
    if (auto* kinematic = std::get_if<Kinematic>(&state.density))
      *kinematic = state.seen.told(*kinematic, background.dims);
  return as_real(std::move(out), background);
}

std::vector<ObjectBelief> read_objects(const Cluster& cluster, Utime at,
                                       const Background& background) {
  return std::move(Objects(cluster, at, background).all());
}

std::vector<ObjectBelief> read_objects(const Belief& belief, Utime at, double min_p,
                                       const Background& background) {
  std::vector<ObjectBelief> out;
  for (const auto& cluster : belief.clusters)
    for (ObjectBelief& object : read_objects(*cluster, at, background))
      if (object.p >= min_p && object.p > 0) out.push_back(std::move(object));
  std::sort(out.begin(), out.end(), [](const ObjectBelief& a, const ObjectBelief& b) {
    return a.anchor->birth < b.anchor->birth;
  });
  return out;
}

}  // namespace anchord
