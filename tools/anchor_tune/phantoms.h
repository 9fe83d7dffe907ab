#pragma once

#include <optional>
#include <vector>

#include "tools/anchor_tune/fleeting.h"
#include "tools/anchor_tune/matching.h"
#include "tools/anchor_tune/motion.h"
#include "tools/anchor_tune/score_memory.h"

namespace anchord::tuning {

/// False detections that are taken for one thing that was reported again and again.
struct FalseChain {
  MeasuredTrack track;
  Looks looks;                   ///< after its first detection
  std::vector<double> log_odds;  ///< of the scores, as long as the track; empty: without
  int sensor = 0;                ///< of its first detection
  bool seen_before = false;      ///< its place had been in view earlier in this recording
};

/// Links false detections over frames: one to one, nearest first, within `model`'s gate (a squared
/// Mahalanobis distance) and `radius` m. A chain ends when its place is not looked at, or was in
/// vain kPatience times.
std::vector<FalseChain> link_false(const Judgement& judgement, const BehaviourModel& model,
                                   double gate_distance2, double radius, int dims);
inline constexpr int kPatience = 10;

/// One kind of phantom.
struct PhantomKind {
  Fleeting fleeting;
  std::optional<Motion> motion;  ///< of the chains that are most probably of this kind
  double arrived = 0;            ///< chains expected to be of it, where it had been looked
  double there = 0;              ///< the same, where nobody had looked before
};

/// All that is told of phantoms.
struct Phantoms {
  std::vector<FalseChain> chains;
  std::vector<PhantomKind> kinds;
  double gain = 0;              ///< in log-likelihood, of hidden states
  std::vector<double> clutter;  ///< chains expected to be none, per sensor of the judgement
};

/// As many kinds as there are `classes` (indices) of phantoms. False detections are linked by the
/// first one's model as it is fitted. Nothing where no false detection was seen again.
std::optional<Phantoms> find_phantoms(const Judgement& judgement, const std::vector<int>& classes,
                                      const Knowledge& knowledge, double radius);

}  // namespace anchord::tuning
