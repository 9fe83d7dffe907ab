#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "anchoring/world.h"
#include "daemon/refold.h"
#include "daemon/worker.h"
#include "knowledge/checkpoint_store.h"
#include "knowledge/log_reader.h"

namespace anchord {

/// Writes checkpoints of the belief beside the log, on a thread of its own, so that a start has
/// little to fold, and questions about the past have. They save time, no more: without them, or
/// where one does not fit, all of the log is folded.
class Checkpointer {
 public:
  /// Work on frames between those that are kept for questions about the past, s: what such a
  /// question may have to do again.
  static constexpr double kPastWork = 2;

  /// `now`: an empty world of the configuration that runs. `interval`: s of work on frames after
  /// which the next one is due; 0: after each batch. No more than a tenth of the time goes into
  /// writing them.
  Checkpointer(const std::string& directory, World now, double interval);

  /// Goes on from the newest checkpoint that fits the log and its configurations; nothing if there
  /// is none. Before take().
  std::optional<Refold> resume(LogReader& log, Configurations& configurations);

  /// Counts work on a frame or event.
  void worked(double seconds);
  /// Whether take() would take one.
  bool due() const;
  /// Takes one of what is durable, if it is due: its last frame or event and that one's checksum.
  /// Costs next to nothing.
  void take(const World& durable, std::int64_t sequence, std::uint32_t frame_checksum);
  /// Waits until what was taken is written.
  void finish();
  /// Makes the next one due.
  void demand() { demanded_ = true; }

  /// Looks for a checkpoint to put in the place of the log's beginning, on its thread: the newest
  /// that holds nothing after `until`; or, for want of room, the oldest that holds at least up to
  /// `sequence`. It is read again, to be sure of it. base() has it then.
  void look_for_base(Utime until, std::int64_t sequence);
  /// What was found, once.
  std::optional<LogBase> base();
  /// Forgets those before the log's base, on its thread.
  void forget_before(std::int64_t sequence);

  /// The sequence of the newest checkpoint. Safe from any thread, as those below.
  std::int64_t newest() const { return newest_; }
  /// Bytes of all checkpoints.
  std::int64_t bytes() const { return bytes_; }

 private:
  struct Taken {
    WorldState state;
    std::shared_ptr<const Background> background;
    std::int64_t sequence;
    std::uint32_t frame_checksum;
    double seconds_per_frame;
  };
  void write(const Taken& taken);

  std::string directory_;
  World now_;
  double interval_;
  double since_ = 0;        ///< s of work since the last one was taken
  double work_ = 0;         ///< s, since the start
  std::int64_t count_ = 0;  ///< frames and events that took that
  bool demanded_ = false;
  std::unique_ptr<CheckpointStore> store_;  ///< none: it cannot be opened
  std::int64_t last_past_ = 0;              ///< sequence of the newest that is kept for questions
  std::atomic<bool> writing_{false};
  std::atomic<double> took_{0};  ///< s, to write the last one
  std::atomic<std::int64_t> newest_{0}, bytes_{0};
  std::mutex mutex_;
  std::optional<LogBase> base_;  // guarded by mutex_
  Worker worker_;                ///< last, so that it ends first
};

}  // namespace anchord
