#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "anchoring/world.h"
#include "api/answers.h"
#include "core/event.h"
#include "core/frame.h"
#include "core/verification.h"
#include "daemon/checkpointer.h"
#include "daemon/history_recorder.h"
#include "daemon/intake.h"
#include "daemon/pace.h"
#include "daemon/retention.h"
#include "daemon/statistics.h"
#include "knowledge/frame_log.h"

namespace anchord {

/// What became of a submission.
struct Receipt {
  std::size_t accepted = 0;  ///< frames that were applied and are durable
  std::size_t repeated = 0;  ///< frames that are in the log, durable, from an earlier time
  /// Of each event its number, which an undo names; 0 for one that is in the log already.
  std::vector<std::int64_t> events;
};

/// Frames, events after them, and the tasks that they change: they stand or fall together.
struct Submission {
  std::vector<Frame> frames;
  std::string origin;  ///< an LCM channel, or HTTP; for messages
  bool array = false;  ///< errors name the frame by its index
  /// Called once, on the journal's thread: when all of it is durable and applied, or with the
  /// refusal. May be empty.
  std::function<void(Result<Receipt>)> done;
  std::vector<Event> events = {};
  std::vector<Task> tasks = {};
  std::size_t bytes = 0;  ///< in which it came from outside; see Intake

  std::size_t size() const { return frames.size() + events.size() + tasks.size(); }
};

/// The one writer: folds submissions into the world, appends them to the frame log, commits in
/// batches, and only then acknowledges. Its thread alone touches the world and the log; everyone
/// else reads the immutable belief it publishes after each submission. If a batch cannot be made
/// durable, its frames are refused and the belief goes back to the last durable one.
class Journal {
 public:
  /// None may throw.
  struct Hooks {
    /// After each applied frame, in their order, and when the belief goes back; on the journal's
    /// thread.
    std::function<void(std::shared_ptr<const Belief>)> applied;
    /// A refused submission, and the frame that is to blame if it is one; on the journal's thread.
    std::function<void(const Submission&, const Frame*, const Error&)> refused;
    /// At least every half second while the journal lives, and for each frame that is restored;
    /// on the thread of restore() and on the journal's.
    std::function<void()> alive;
    /// What time the machine's clock says, by which frames from the future are told; it may jump.
    std::function<Utime()> now = clock_time;
  };
  static Utime clock_time();
  /// Frames are committed at most this long after they were applied; those that somebody waits for
  /// as soon as nothing else is to be applied.
  static constexpr std::chrono::milliseconds kBatch{30};
  /// Frames that may wait; more are refused.
  static constexpr std::size_t kQueue = Intake::kFrames;
  /// How long frames that wait are still applied at the end; those left over are refused.
  static constexpr std::chrono::milliseconds kEnding{500};

  /// `checkpointer` may be null: all of the log is folded then.
  Journal(World world, std::unique_ptr<FrameLog> log, Statistics& statistics, UpdateTimes& times,
          Hooks hooks, std::unique_ptr<Checkpointer> checkpointer = nullptr);
  /// Finishes what has been submitted, within kEnding, commits, ends.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Folds the log, from the newest checkpoint on, each frame under the configuration that was in
  /// force then, and goes on from there under the one that runs now; to be called once, before
  /// start(). Stops when `cancelled` turns true. kConflict: the configuration has taken away what
  /// is in use, which the field names.
  Status restore(const std::atomic<bool>& cancelled);
  /// The tasks that the log keeps; after restore(), before start().
  Result<std::vector<Task>> tasks();
  void start();

  /// Hands frames in, from any thread. False, and `done` not called, if too many wait.
  bool submit(Submission submission);

  /// What waits. Safe from any thread.
  Intake::State waiting() const;

  /// What to answer from. Safe from any thread.
  Snapshot snapshot() const { return {published_.load(), background_}; }
  std::int64_t logged_frames() const { return sequence_; }
  /// How many of them restore() took from a checkpoint.
  std::int64_t resumed_frames() const { return resumed_; }
  /// How many of them the newest checkpoint holds; 0 without one. Safe from any thread.
  std::int64_t checkpoint() const { return checkpointer_ ? checkpointer_->newest() : 0; }
  /// What the log takes on the disk. Safe from any thread.
  struct Kept {
    std::int64_t first = 1;           ///< the oldest frame or event that it holds
    std::int64_t used = 0, free = 0;  ///< bytes of the database
    std::int64_t checkpoints = 0;     ///< bytes
    double longest_pause = 0;         ///< s for which a checkpoint has held up frames, at most
  };
  Kept kept() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Pending {
    Submission submission;
    Receipt receipt;
  };
  /// A frame that the world has taken and the log has not.
  struct Folded {
    LoggedFrame frame;
    std::shared_ptr<const Belief> after;
  };
  /// Tasks that the log keeps.
  static constexpr std::int64_t kTasks = 2000;
  void run();
  bool commit_is_due() const;
  void take(Submission submission);
  Status fold(const Frame& frame, std::vector<Folded>& folded);
  Status check_leap(Utime utime);
  void warn_of_the_future();
  Status fold(const Event& event, std::vector<Folded>& folded, Receipt& receipt);
  Result<bool> repeated(const LoggedFrame& frame, const std::vector<Folded>& folded);
  Status append(const std::vector<Folded>& folded, const std::vector<Task>& tasks);
  Status keep_configuration();
  Status keep_past();
  void count_work(Clock::time_point begin);
  void take_checkpoint();
  void commit();
  void roll_back(const Error& why);
  void refuse(Submission& submission, const Frame* frame, const Error& why);
  void publish(const std::shared_ptr<const Belief>& belief);

  World world_, durable_;
  const std::shared_ptr<const Background> background_;
  std::unique_ptr<FrameLog> log_;
  Statistics& statistics_;
  UpdateTimes& times_;
  Pace pace_;
  Hooks hooks_;
  const std::unique_ptr<Checkpointer> checkpointer_;
  std::atomic<std::int64_t> sequence_{0};
  std::int64_t durable_sequence_ = 0;
  std::int64_t resumed_ = 0;         ///< the sequence that restore() went on from
  std::uint64_t restored_late_ = 0;  ///< late frames before the start
  std::vector<Pending> pending_;
  Clock::time_point batch_began_;
  bool batch_open_ = false;
  bool awaited_ = false;  ///< somebody waits for the open batch
  bool failing_ = false;  ///< the last batch could not be made durable
  bool warned_ = false;   ///< that the newest frame is ahead of the clock
  /// Whether the log says under which configuration its next frame comes; as of the last commit.
  bool configured_ = false, durable_configured_ = false;
  HistoryRecorder recorder_;
  Retention retention_;

  std::atomic<std::shared_ptr<const Belief>> published_;
  std::atomic<std::int64_t> first_{1}, used_{0}, free_{0};
  std::atomic<double> longest_pause_{0};

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Submission> queue_;  // guarded by mutex_, as all below
  Intake intake_;                 ///< of the queue
  bool ending_ = false;
  Clock::time_point ends_;  ///< when what waits is refused
  std::thread thread_;
};

}  // namespace anchord
