#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "anchoring/belief.h"
#include "core/result.h"
#include "core/verification.h"
#include "maintenance/planner.h"

namespace anchord {

/// What a result means for the belief, if anything, and its task as it is then.
struct TaskEnd {
  Task task;
  std::optional<Frame> frame;  ///< found: to be applied
  std::optional<Event> event;  ///< missing: to be applied
};

/// Decides what is looked at and keeps the tasks (thesis section 3.5.4). It has no clock and no
/// thread: `now` is handed in, and does not go back. Every call that changes tasks returns them as
/// they are then. Not thread-safe.
class Coordinator {
 public:
  explicit Coordinator(std::shared_ptr<const Background> background,
                       const PlannerLimits& limits = {});
  Coordinator(const Coordinator&) = delete;
  Coordinator& operator=(const Coordinator&) = delete;

  const Site& site() const { return site_; }

  /// A planner demands a look at `object`, an anchor's id, which the caller has made out from the
  /// trigger. A trigger for an object that a triggered task waits for, or is issued for, joins it
  /// (its tag is added, the later deadline holds), unless `alone`, or the two ask for different
  /// robots or sensors. Nothing is returned for an action that needs no look. Refuses: kInvalid an
  /// unknown action or sensor, a sensor without `verification`, a timeout that is no number of
  /// seconds; kUnavailable when kMaxActive tasks wait or are issued.
  Result<std::optional<Task>> add(const Trigger& trigger, const std::string& object,
                                  const std::string& object_class, Utime now);

  /// kUnknown: no such task. kConflict: it has ended.
  Result<Task> cancel(std::int64_t id, Utime now);

  /// Checks a result and says what follows; changes nothing. The caller applies frame or event to
  /// the belief, and if that is accepted calls end(). kUnknown: no such task; kConflict: it waits
  /// still, or has ended, past its deadline included; kInvalid: not what a result must be.
  Result<TaskEnd> check(const VerificationResult& result, Utime now) const;
  void end(const TaskEnd& end);

  /// While a result is on its way to the log its task is in hand: nothing else changes it.
  void take_in_hand(std::int64_t id) { in_hand_.insert(id); }
  void put_back(std::int64_t id) { in_hand_.erase(id); }

  /// Ends the tasks whose deadline has come.
  std::vector<Task> expire(Utime now);

  /// Issues tasks, at most one per robot that has none: first what waits, first come first served
  /// (3.12), then, if enabled, the coordinator's own choice. A waiting task whose object is not in
  /// the belief any more ends as cancelled. `robots`: where each one is; none: one robot without
  /// a pose, which is given triggered tasks only, without a viewpoint. A robot that was named but
  /// has no pose yet likewise. Returns what was issued or ended.
  std::vector<Task> next(Utime now, const Belief& belief, const std::vector<RobotPose>& robots);

  /// After a restart: tasks as they were, in any order. Only before the first add() or next().
  /// Issued ones stay issued until their deadline.
  void restore(std::vector<Task> tasks);

  /// A task, or null. The pointer holds until the next call that changes tasks.
  const Task* find(std::int64_t id) const;
  /// All that are kept, in order of id: those that wait or are issued, and the last kMaxEnded
  /// ended.
  std::vector<Task> tasks() const;
  /// Those that have not ended, in order.
  std::vector<Task> open_tasks() const;
  std::int64_t last_id() const { return last_id_; }

  static constexpr std::size_t kMaxActive = 256;
  static constexpr std::size_t kMaxEnded = 1000;
  static constexpr double kMaxTimeout = 1e6;  ///< s

 private:
  class Reading;
  void leave_aside(const std::string& object, Utime now);
  Task finish(std::int64_t id, Task::State state, Utime now, std::string reason);
  bool busy(const std::string& robot) const;
  Task* to_join(const Trigger& trigger, const std::string& object, Utime now);
  const RobotPose* issue_triggered(Task& task, const ObjectBelief& object, const Reading& reading,
                                   const std::vector<const RobotPose*>& robots, Utime now);
  std::optional<Task> make_way(const std::string& robot, Utime now);
  std::optional<Task> own_choice(const Reading& reading, const RobotPose& robot, Utime now);

  std::shared_ptr<const Background> background_;
  const Site site_;
  const PlannerLimits limits_;
  std::map<std::int64_t, Task> active_;  ///< queued and issued, by id: in order of arrival
  std::set<std::int64_t> in_hand_;       ///< of those
  std::deque<Task> ended_;               ///< in order of ending
  std::map<std::string, Utime> aside_;   ///< objects nobody sets out for until then
  std::int64_t last_id_ = 0;
};

}  // namespace anchord
