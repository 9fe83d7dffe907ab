#include "anchoring/leading.h"

#include <cmath>

#include "anchoring/reading.h"
#include "core/scratch.h"
#include "models/kinematic.h"

namespace anchord {
namespace {

const double kClearly = std::log(kClearlyOther);
/// Positions closer than this, in standard deviations of their difference, are the same spot.
constexpr double kSameSpot = 1;

class Names {
 public:
  Names(const Cluster& cluster, const Background& background)
      : cluster_(cluster), background_(background) {}

  /// Whether a hypothesis has each object about where the world shown so far has it, and none under
  /// another name.
  bool kept_by(const Hypothesis& h) const {
    for (std::size_t a = 0; a < h.leaf.size(); ++a) {
      const int shown = cluster_.anchors[a].shown;
      if (h.leaf[a] == shown || !stands(a, shown)) continue;
      if (stands(a, h.leaf[a]) ? apart(leaf(a, shown), leaf(a, h.leaf[a])) : taken(h, a))
        return false;
    }
    return true;
  }

  /// Whether two hypotheses have objects in the same spots, only under other names.
  bool only_differ(const Hypothesis& g, const Hypothesis& h) const {
    const Scratch scratch;
    ScratchVector<const Leaf*> in_g, in_h;
    for (std::size_t a = 0; a < h.leaf.size(); ++a) {
      if (g.leaf[a] == h.leaf[a]) continue;
      if (stands(a, g.leaf[a])) in_g.push_back(&leaf(a, g.leaf[a]));
      if (stands(a, h.leaf[a])) in_h.push_back(&leaf(a, h.leaf[a]));
    }
    if (in_g.size() != in_h.size()) return false;
    for (const Leaf* one : in_g) {
      auto like = in_h.begin();
      while (like != in_h.end() && apart(*one, **like)) ++like;
      if (like == in_h.end()) return false;
      in_h.erase(like);
    }
    return true;
  }

 private:
  /// Whether what was shown of an anchor is in a hypothesis another one's, which was not there.
  bool taken(const Hypothesis& h, std::size_t anchor) const {
    const Leaf& was = leaf(anchor, cluster_.anchors[anchor].shown);
    for (std::size_t b = 0; b < h.leaf.size(); ++b) {
      const int shown = cluster_.anchors[b].shown;
      if (b == anchor || !stands(b, h.leaf[b]) || apart(was, leaf(b, h.leaf[b]))) continue;
      if (!stands(b, shown) || apart(leaf(b, shown), leaf(b, h.leaf[b]))) return true;
    }
    return false;
  }

  const Leaf& leaf(std::size_t anchor, int l) const { return *cluster_.anchors[anchor].leaves[l]; }
  bool stands(std::size_t anchor, int l) const {
    return l != Hypothesis::kNoLeaf && real_existence(leaf(anchor, l), background_) >= kBelievedIn;
  }
  bool apart(const Leaf& a, const Leaf& b) const {
    const double d2 =
        fit(position_of(a), position_of(b).position_density(), background_.dims).distance2;
    return d2 > kSameSpot * kSameSpot;
  }

  const Cluster& cluster_;
  const Background& background_;
};

int leading(const Cluster& cluster, const Background& background) {
  const Hypothesis& best = cluster.hypotheses.front();
  const Names names(cluster, background);
  if (names.kept_by(best)) return 0;
  for (std::size_t h = 1; h < cluster.hypotheses.size(); ++h) {
    const Hypothesis& other = cluster.hypotheses[h];
    if (other.log_weight + kClearly < best.log_weight) break;
    if (names.kept_by(other) && names.only_differ(best, other)) return static_cast<int>(h);
  }
  return 0;
}

}  // namespace

void choose_leading(Cluster& cluster, const Background& background) {
  cluster.leading = cluster.hypotheses.size() > 1 ? leading(cluster, background) : 0;
  const Hypothesis& shown = cluster.hypotheses[cluster.leading];
  for (std::size_t a = 0; a < cluster.anchors.size(); ++a) cluster.anchors[a].shown = shown.leaf[a];
}

}  // namespace anchord
