#pragma once

#include "anchoring/belief.h"
#include "daemon/checkpointer.h"
#include "knowledge/frame_log.h"
#include "knowledge/knowledge.h"

namespace anchord {

/// Keeps the log within LogLimits: what is too old, or too much, is given up for a checkpoint that
/// it was folded into, and the history is thinned with age. A little at a time, in batches that are
/// committed anyway. One thread at a time.
class Retention {
 public:
  /// Frames that go with one batch.
  static constexpr std::int64_t kAtOnce = 200;
  /// Rows of history that are looked at with one batch.
  static constexpr std::int64_t kRowsAtOnce = 300;
  /// Batches between two looks at whether there is something to do.
  static constexpr int kPause = 32;

  explicit Retention(LogLimits limits) : limits_(limits) {}

  /// Does a bit of what is to be done, in the log's open batch. `newest`: the belief's time.
  Status step(FrameLog& log, Checkpointer* checkpointer, Utime newest);

 private:
  Status look(FrameLog& log, Checkpointer* checkpointer, Utime newest);
  Status thin(FrameLog& log, Utime newest);

  LogLimits limits_;
  int pause_ = 0;
  bool dropping_ = true;   ///< a base may stand there from before
  std::size_t grain_ = 0;  ///< whose turn it is
};

}  // namespace anchord
