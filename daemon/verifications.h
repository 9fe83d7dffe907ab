#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/verification.h"
#include "daemon/journal.h"
#include "daemon/robots.h"
#include "daemon/worker.h"
#include "maintenance/coordinator.h"

namespace anchord {

/// The coordinator at work: takes triggers and results from any thread, decides on one of its own
/// what is looked at, and publishes each task when the log has it. It reads snapshots of the belief
/// and never delays a frame. Its time is the world's: the newest frame's, going on with the clock.
class Verifications {
 public:
  /// Told of each change of a task once it is durable, on the journal's thread.
  using Publish = std::function<void(const Task&, Utime now)>;
  using TaskDone = std::function<void(Result<std::optional<Task>>)>;

  Verifications(Journal& journal, Robots& robots, Publish publish);
  /// stop().
  ~Verifications();
  Verifications(const Verifications&) = delete;
  Verifications& operator=(const Verifications&) = delete;

  /// Takes up the tasks that the log keeps. After Journal::restore(), before anything is received.
  Status restore();
  /// Begins to decide.
  void start();
  void stop();

  /// A planner's trigger. `done`, which may be empty, is called once, on any thread: with the task
  /// when it is durable, with nothing for an action that needs no look, or with the refusal.
  /// kUnknown: nothing is called so, or nothing fits the description.
  void trigger(const Trigger& trigger, TaskDone done);
  void cancel(std::int64_t id, TaskDone done);
  /// A verification module's answer. What it says of the belief is folded and durable by `done`.
  void result(const VerificationResult& result, TaskDone done);

  /// Where a robot is; objects that it holds move with it. Refuses what Robots::set() does.
  Status pose(const RobotPose& pose);

  std::vector<Task> tasks() const;
  /// Those that have not ended.
  std::vector<Task> open_tasks() const;
  std::optional<Task> find(std::int64_t id) const;
  /// Tasks that wait, and those that are issued.
  std::pair<std::size_t, std::size_t> open() const;

 private:
  using Clock = std::chrono::steady_clock;
  Utime now();
  void run();
  void decide();
  void keep(const std::vector<Task>& tasks);
  void acknowledge(std::function<void()> task);
  void tell_again();
  void carry(const RobotPose& pose);
  Result<std::pair<std::string, std::string>> meant(const Trigger& trigger) const;

  Journal& journal_;
  Robots& robots_;
  Publish publish_;

  std::mutex carrying_;
  std::map<std::string, RobotPose> carried_;  ///< where what a robot holds was last put; guarded

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Coordinator coordinator_;        // guarded by mutex_, as all below
  std::set<std::int64_t> unkept_;  ///< changed tasks that the log could not take yet
  Utime newest_ = 0;               ///< of the belief, since `since_`
  Clock::time_point since_;
  Utime last_now_ = 0;
  Clock::time_point told_;  ///< when issued tasks were last published
  bool woken_ = false, ending_ = false;
  std::thread thread_;
  /// Takes mutex_ where the journal's thread must not wait for it.
  Worker acknowledgements_;
};

}  // namespace anchord
