#include "anchoring/score_trace.h"

#include <cmath>

namespace anchord {

ScoreTrace ScoreTrace::predicted(const ScoreMemory& memory, Utime utime) const {
  ScoreTrace out;
  out.variance_ = memory.share;
  out.utime_ = utime;
  if (utime_ == 0 || memory.share <= 0) return out;
  const double kept = std::exp(-seconds_between(utime_, utime) / memory.seconds);
  out.mean_ = kept * mean_;
  out.response_ = kept * response_;
  out.variance_ = kept * kept * variance_ + (1 - kept * kept) * memory.share;
  return out;
}

double ScoreTrace::log_ratio(const ScoreEvidence& evidence, Utime utime) const {
  const ScoreTrace now = predicted(evidence.memory, utime);
  return (1 - now.response_) * (evidence.log_ratio - now.mean_) /
         (now.variance_ + 1 - evidence.memory.share);
}

void ScoreTrace::take(const ScoreEvidence& evidence, Utime utime) {
  *this = predicted(evidence.memory, utime);
  const double gain = variance_ / (variance_ + 1 - evidence.memory.share);
  mean_ += gain * (evidence.log_ratio - mean_);
  response_ += gain * (1 - response_);
  variance_ *= 1 - gain;
}

}  // namespace anchord
