#pragma once

#include "core/time.h"
#include "knowledge/knowledge.h"

namespace anchord {

/// What a detection's score says: ln f1(s)/f0(s), of objects over what is none.
struct ScoreEvidence {
  double log_ratio = 0;
  ScoreMemory memory;
};

/// What the scores that one thing was reported with so far let expect of its next one. The thing
/// that looked like an object a frame ago looks like one still, for the same reasons, be it one or
/// not: scores of one thing are not independent. Given what it is, the log-ratio is normal about
/// half its distance between both; a share of the variance is a part that lasts (an
/// Ornstein-Uhlenbeck process), the rest is new in every frame. So what a score says about what the
/// thing is, is what it says beyond the scores before: a Kalman filter of one number
/// (docs/belief.md, Phantoms).
class ScoreTrace {
 public:
  /// ln f1(s | scores before) / f0(s | scores before).
  double log_ratio(const ScoreEvidence& evidence, Utime utime) const;
  /// Takes the score that this was said of.
  void take(const ScoreEvidence& evidence, Utime utime);

  /// What it holds, for a checkpoint.
  template <typename Archive>
  void serialize(Archive& archive) {
    archive(mean_, response_, variance_, utime_);
  }

 private:
  /// The lasting part at a later time.
  ScoreTrace predicted(const ScoreMemory& memory, Utime utime) const;

  // In units of the log-ratio, variances in those of a score's.
  double mean_ = 0;      ///< of the lasting part, halfway between what it would be for both
  double response_ = 0;  ///< by how much of their distance both expect the next score apart less
  double variance_ = 0;
  Utime utime_ = 0;  ///< 0: no score yet
};

}  // namespace anchord
