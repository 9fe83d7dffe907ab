#include "anchoring/association.h"

#include <algorithm>
#include <cmath>

#include "anchoring/cluster.h"
#include "anchoring/reduction.h"
#include "anchoring/shared_detection.h"
#include "anchoring/tied.h"
#include "anchoring/twins.h"
#include "core/log_probability.h"
#include "mht/ranked_associations.h"

namespace anchord {
namespace {

constexpr int kMiss = -1;    // in place of a detection
constexpr int kUnmade = -2;  // a child leaf that no hypothesis has asked for yet

/// Merging makes room: up to this many times `max` associations are looked at before the best `max`
/// are kept, as long as one more carries more than 1e-4 of the weight so far. Of a parent of which
/// not one is among them the best is formed, too: two like objects that have perhaps exchanged
/// their places may be told apart only minutes later, against whatever odds.
constexpr std::size_t kLookAhead = 2;
constexpr double kWorthLookingAhead = -9.210340371976182;  // ln 1e-4

/// The leaves after the frame, made when a hypothesis first needs them.
class Children {
 public:
  Children(const Tied& tied, const ScratchVector<int>& detections, const MapFrame& frame,
           std::uint64_t frame_number, const Visibility& visibility, const Occlusion& occlusion,
           const Background& background)
      : tied_(tied),
        detections_(detections),
        frame_(frame),
        frame_number_(frame_number),
        visibility_(visibility),
        occlusion_(occlusion),
        background_(background),
        number_(tied.leaves.size() * (detections.size() + 1), kUnmade) {}

  /// The number, within its anchor's tree, of the leaf after it was given a detection (a position
  /// in `detections`) or kMiss; kNoLeaf if it hardly exists any more.
  int of(int leaf, int z, AnchorTree& tree) {
    int& number = number_[leaf * (detections_.size() + 1) + z + 1];
    if (number == kUnmade) {
      auto child = make_pooled<Leaf>(tied_.leaves[leaf]->leaf);
      become(*child, *tied_.leaves[leaf], z, tree.anchor->birth);
      if (child->existence < background_.knowledge.limits.min_existence || child->existence <= 0) {
        number = Hypothesis::kNoLeaf;
      } else {
        number = static_cast<int>(tree.leaves.size());
        tree.leaves.push_back(std::move(child));
      }
    }
    return number;
  }

 private:
  void become(Leaf& child, const PredictedLeaf& parent, int z, std::uint64_t birth) const {
    int given = z == kMiss ? kMiss : detections_[z];
    if (z == kMiss && background_.shares)
      given = draw_to_hosts(child, frame_, parent.shown, background_);
    const auto depth = static_cast<std::uint64_t>(background_.knowledge.limits.scan_depth);
    if (depth > 0) {
      const auto old = [&](std::uint64_t r) { return (r >> 16) + depth <= frame_number_; };
      child.recent.erase(std::remove_if(child.recent.begin(), child.recent.end(), old),
                         child.recent.end());
      if (given != kMiss) child.recent.push_back(frame_number_ << 16 | given);
    }
    if (z == kMiss) {
      give_nothing(child, parent.shown, visibility_, *frame_.sensor, background_);
    } else {
      give(child, frame_.detections[detections_[z]], parent.shown, *frame_.sensor, background_);
      visibility_.find(child, occlusion_, birth);
    }
  }

  const Tied& tied_;
  const ScratchVector<int>& detections_;
  const MapFrame& frame_;
  std::uint64_t frame_number_;
  const Visibility& visibility_;
  const Occlusion& occlusion_;
  const Background& background_;
  ScratchVector<int> number_;
};

/// When to stop looking at associations, of which the best come first.
class Enough {
 public:
  Enough(const Limits& limits, const Allowance& allowance)
      : kept_(limits.max_hypotheses), allowed_(allowance.associations) {}

  /// After so many whatever they weigh.
  bool full(std::size_t formed) const {
    return (allowed_ && formed >= *allowed_) || (kept_ > 0 && formed >= kLookAhead * kept_);
  }
  /// After so many, the last of which carries `log_share` of their weight.
  bool are(std::size_t formed, double log_share) const {
    return full(formed) || (kept_ > 0 && formed >= kept_ && log_share < kWorthLookingAhead);
  }

 private:
  std::size_t kept_;  // 0: no bound
  std::optional<std::size_t> allowed_;
};

/// Makes the hypotheses of each parent weigh together what all its associations would, where only
/// the best were formed. Else a rarer parent, of which fewer were, would lose by that each frame.
void restore(const ScratchVector<int>& parent, const ScratchVector<double>& log_evidence,
             HypothesisSet& hypotheses) {
  ScratchVector<double> formed(log_evidence.size(), kLogZero);
  for (std::size_t h = 0; h < hypotheses.size(); ++h)
    formed[parent[h]] = log_add(formed[parent[h]], hypotheses[h].log_weight);
  for (std::size_t h = 0; h < hypotheses.size(); ++h)
    hypotheses[h].log_weight += std::max(0.0, log_evidence[parent[h]] - formed[parent[h]]);
}

/// What detection z starts: an anchor with one leaf, or nothing worth keeping.
std::shared_ptr<Leaf> birth(int z, const MapFrame& frame, const Origin& origin,
                            std::uint64_t frame_number, const Background& background) {
  const Limits& limits = background.knowledge.limits;
  if (origin.existence <= 0 || origin.existence < limits.min_existence) return nullptr;
  Leaf leaf = first_leaf(frame.detections[z], origin.terms, origin.existence, frame.utime,
                         background, origin.met);
  if (limits.scan_depth > 0) leaf.recent.push_back(frame_number << 16 | z);
  return make_pooled<Leaf>(std::move(leaf));
}

}  // namespace

bool PredictedCluster::touched() const {
  return shown || stepped || std::find(gated.begin(), gated.end(), 1) != gated.end();
}

bool PredictedCluster::departed(double min_existence) const {
  for (const auto& anchor : leaves)
    for (const PredictedLeaf& predicted : anchor)
      if (predicted.leaf.existence >= min_existence) return false;
  return true;
}

Associated associate(const ScratchVector<PredictedCluster>& clusters,
                     const ScratchVector<int>& detections, const MapFrame& frame,
                     const ScratchVector<Origin>& origins, const Visibility& visibility,
                     const Occlusion& occlusion, const Background& background, const Belief& belief,
                     const Allowance& allowance) {
  const Scratch scratch;  // each group in the memory that the last one has left warm
  const Limits& limits = background.knowledge.limits;
  const Tied tied = tie(clusters, limits, allowance.parents);
  const AssociationProblem problem = problem_of(tied, detections);
  const std::size_t old_anchors = tied.anchors.size();

  Cluster joint;
  joint.anchors.reserve(old_anchors + detections.size());
  for (std::size_t a = 0; a < old_anchors; ++a) {
    joint.anchors.push_back({tied.anchors[a], {}});
    const bool is_last = a + 1 == old_anchors;
    const std::size_t end = is_last ? tied.leaves.size() : tied.first_leaf[a + 1];
    joint.anchors[a].leaves.reserve(2 * (end - tied.first_leaf[a]));  // given something, or not
  }
  ScratchVector<int> anchor_of(detections.size(), -1);  // that a detection starts
  for (std::size_t z = 0; z < detections.size(); ++z) {
    auto leaf = birth(detections[z], frame, origins[detections[z]], belief.frames, background);
    if (!leaf) continue;
    anchor_of[z] = static_cast<int>(joint.anchors.size());
    auto anchor =
        make_pooled<const Anchor>(Anchor{belief.births + detections[z] + 1, "", "", std::nullopt});
    visibility.find(*leaf, occlusion, anchor->birth);
    joint.anchors.push_back({std::move(anchor), {std::move(leaf)}});
  }

  joint.hypotheses.reserve(tied.hypotheses().size());
  Children children(tied, detections, frame, belief.frames, visibility, occlusion, background);
  RankedAssociations ranked(problem, background.log_least_weight);
  const Enough enough(limits, allowance);
  Associated out;
  double total = kLogZero;
  ScratchVector<int> given(tied.leaves.size(), kMiss);  // per leaf
  double least = kLogZero;                              // what is below has not been looked at
  ScratchVector<int> parent_of;                         // per hypothesis
  ScratchVector<char> formed(tied.hypotheses().size(), 0);
  const auto form = [&](const Association& next) {
    Hypothesis h{next.log_weight, {}};
    h.leaf.resize(joint.anchors.size(), Hypothesis::kNoLeaf);
    for (std::size_t z = 0; z < detections.size(); ++z) {
      if (next.leaf_of[z] != Association::kNone)
        given[next.leaf_of[z]] = static_cast<int>(z);
      else if (anchor_of[z] >= 0)
        h.leaf[anchor_of[z]] = 0;
    }
    const Hypothesis& parent = tied.hypotheses()[next.parent];
    for (std::size_t a = 0; a < old_anchors; ++a) {
      if (parent.leaf[a] == Hypothesis::kNoLeaf) continue;
      const int leaf = tied.first_leaf[a] + parent.leaf[a];
      h.leaf[a] = children.of(leaf, given[leaf], joint.anchors[a]);
    }
    for (const int leaf : next.leaf_of)
      if (leaf != Association::kNone) given[leaf] = kMiss;
    // The most probable child of the world that was shown is its heir.
    if (next.parent == tied.leading && !formed[next.parent])
      for (std::size_t a = 0; a < old_anchors; ++a) joint.anchors[a].shown = h.leaf[a];
    formed[next.parent] = 1;
    joint.hypotheses.push_back(std::move(h));
    parent_of.push_back(next.parent);
  };
  while (auto next = ranked.next()) {
    // Below this a weight stays below min_weight whatever else is found.
    if (next->log_weight < total + background.log_least_weight) break;
    total = log_add(total, next->log_weight);
    form(*next);
    if (enough.are(joint.hypotheses.size(), next->log_weight - total)) {
      least = next->log_weight;
      break;
    }
  }
  double dropped = 0;
  if (least != kLogZero) {
    double looked_at = total;
    const auto evidence = ranked.log_evidence();
    total = log_sum(evidence, [](double of_parent) { return of_parent; });
    for (std::size_t p = 0; p < evidence.size(); ++p) {
      if (formed[p] || enough.full(joint.hypotheses.size()) ||
          evidence[p] < total + background.log_least_weight)
        continue;
      const Association best = ranked.best_of(static_cast<int>(p));
      looked_at = log_add(looked_at, best.log_weight);
      form(best);
    }
    dropped = std::max(0.0, -std::expm1(looked_at - total));
    restore(parent_of, evidence, joint.hypotheses);
  }
  const std::size_t looked = joint.hypotheses.size();
  out.log_evidence = total;
  for (const int z : detections) out.log_evidence += origins[z].log_weight;
  merge_equal(joint.hypotheses);
  if (limits.scan_depth > 0) {
    merge_alike(joint, background);
    if (limits.max_hypotheses > 0) join_twins(joint, background);
    // Versions that were merged in several hypotheses alike are then one.
    if (merge_nearest(joint, limits.max_hypotheses, background)) merge_alike(joint, background);
  }
  out.effort.cut =
      tied.cut || (allowance.associations && looked >= *allowance.associations && dropped > 0);
  out.effort.work = (tied.hypotheses().size() + looked) * joint.anchors.size();
  out.effort.dropped =
      tied.dropped + dropped + prune(joint.hypotheses, limits.max_hypotheses, limits.min_weight);
  forget_improbable(joint, background);
  out.clusters =
      split(std::move(joint), background, least == kLogZero ? 0 : std::exp(least - total));
  return out;
}

}  // namespace anchord
