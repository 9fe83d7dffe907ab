#include "daemon/retention.h"

#include <algorithm>

namespace anchord {
namespace {

/// Of a log that is to be made smaller so much goes, so that it need not be done again at once.
constexpr std::int64_t kShare = 10;  // one of so many frames

}  // namespace

Status Retention::step(FrameLog& log, Checkpointer* checkpointer, Utime newest) {
  if (dropping_) {
    const auto dropped = log.drop(kAtOnce);
    if (!dropped) return dropped.error();
    dropping_ = *dropped > 0;
    return Done{};
  }
  if (checkpointer)
    if (const auto base = checkpointer->base(); base && base->first_kept > log.first_sequence()) {
      if (Status put = log.put_base(*base); !put) return put;
      checkpointer->forget_before(base->checkpoint.sequence);
      dropping_ = true;
      return Done{};
    }
  if (++pause_ % kPause != 0) return Done{};
  if (checkpointer)
    if (Status looked = look(log, checkpointer, newest); !looked) return looked;
  return thin(log, newest);
}

/// Asks for a base if the log is over its limits.
Status Retention::look(FrameLog& log, Checkpointer* checkpointer, Utime newest) {
  const std::int64_t first = log.first_sequence(), last = log.last_sequence();
  if (limits_.keep > 0) {
    const Utime until = newest - from_seconds(limits_.keep);
    const auto oldest = log.reader().at(first);
    if (!oldest) return oldest.error();
    if (*oldest && (*oldest)->utime < until) checkpointer->look_for_base(until, 0);
  }
  if (limits_.max_bytes > 0) {
    const auto size = log.size();
    if (!size) return size.error();
    if (size->used > limits_.max_bytes) {
      const std::int64_t enough = first + std::max<std::int64_t>(1, (last - first) / kShare);
      checkpointer->look_for_base(0, enough);
      if (checkpointer->newest() < enough) checkpointer->demand();
    }
  }
  return Done{};
}

Status Retention::thin(FrameLog& log, Utime newest) {
  const HistoryGrain& tier = kHistoryGrains[grain_++ % kHistoryGrains.size()];
  const auto thinned = log.thin_history(tier.grain, newest - from_seconds(tier.age), kRowsAtOnce);
  return thinned ? Status(Done{}) : Status(thinned.error());
}

}  // namespace anchord
