#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "anchoring/world.h"
#include "daemon/worker.h"
#include "knowledge/checkpoint_store.h"
#include "knowledge/frame_log.h"

namespace anchord {

/// Writes checkpoints of the belief beside the log, on a thread of its own, so that a start has
/// little to fold. They save time, no more: without them, or where one does not fit, all of the log
/// is folded.
class Checkpointer {
 public:
  /// `interval`: s of work on frames after which the next one is due; 0: after each batch. No more
  /// than a tenth of the time goes into writing them.
  Checkpointer(const std::string& directory, std::shared_ptr<const Background> background,
               double interval);

  /// Resumes the world where the newest checkpoint left it that fits the log and this
  /// configuration. Returns its sequence; 0 if there is none, and the world is as it was. Before
  /// take().
  std::int64_t resume(World& world, FrameLog& log);

  /// Counts work on frames.
  void worked(double seconds) { since_ += seconds; }
  /// Whether take() would take one.
  bool due() const;
  /// Takes one of what is durable, if it is due: its last frame or event and that one's checksum.
  /// Costs next to nothing.
  void take(const World& durable, std::int64_t sequence, std::uint32_t frame_checksum);

  /// The sequence of the newest checkpoint. Safe from any thread.
  std::int64_t newest() const { return newest_; }

 private:
  void write(const WorldState& state, std::int64_t sequence, std::uint32_t frame_checksum);

  std::shared_ptr<const Background> background_;
  double interval_;
  double since_ = 0;                        ///< s of work since the last one was taken
  std::unique_ptr<CheckpointStore> store_;  ///< none: it cannot be opened
  std::atomic<bool> writing_{false};
  std::atomic<double> took_{0};  ///< s, to write the last one
  std::atomic<std::int64_t> newest_{0};
  Worker worker_;  ///< last, so that it ends first
};

}  // namespace anchord
