#pragma once

#include <functional>
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
  std::vector<double> ranges;    ///< m, where there are scores
  int sensor = 0;                ///< of its first detection
  bool seen_before = false;      ///< its place had been in view earlier in this recording
};

/// Of which false detections phantoms are told.
using Wanted = std::function<bool(const Judged&)>;

/// Links the wanted false detections over frames: one to one, nearest first, within `model`'s gate
/// (a squared Mahalanobis distance) and `radius` m. A chain ends when its place is not looked at,
/// or was in vain kPatience times.
std::vector<FalseChain> link_false(const Judgement& judgement, const Wanted& wanted,
                                   const BehaviourModel& model, double gate_distance2,
                                   double radius, int dims);
inline constexpr int kPatience = 10;

/// One kind of phantom.
struct PhantomKind {
  Fleeting fleeting;
  std::optional<Motion> motion;  ///< of what it looks like, or its most probable chains
  double arrived = 0;            ///< chains expected to be of it, where it had been looked
  double there = 0;              ///< the same, where nobody had looked before
};

/// All that is told of phantoms of one look.
struct Phantoms {
  int look = -1;  ///< the class as which they are reported; -1: any
  std::vector<FalseChain> chains;
  std::vector<PhantomKind> kinds;
  double gain = 0;              ///< in log-likelihood, of hidden states
  std::vector<double> clutter;  ///< chains expected to be none, per sensor of the judgement
};

/// As many kinds as there are `classes` (indices) of phantoms. False detections are linked by the
/// first one's model as it is fitted. Nothing where no false detection was seen again. They move as
/// the class does that they `look` like: a thing goes by its likeliest class's models, and what may
/// yet prove to be an object must not be lost until then.
std::optional<Phantoms> find_phantoms(const Judgement& judgement, const Wanted& wanted, int look,
                                      const std::vector<int>& classes, const Knowledge& knowledge,
                                      double radius);

}  // namespace anchord::tuning
