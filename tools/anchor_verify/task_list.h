#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/verification.h"
#include "perception/look_series.h"

namespace anchord {

/// The verification tasks that wait for a look: those that are issued, for one sensor. At most
/// kMostTasks; the oldest goes when one more comes. Safe from any thread.
class TaskList {
 public:
  static constexpr std::size_t kMostTasks = 64;

  /// `robot`, `sensor`: whose tasks. `looks`: in a row that decide (see LookSeries).
  TaskList(std::string robot, std::string sensor, int dims, int looks)
      : robot_(std::move(robot)), sensor_(std::move(sensor)), dims_(dims), looks_(looks) {}

  /// Takes a task as it was published. One that is no longer issued, or now another's, goes.
  /// Refuses what check_task() does.
  Status add(const Task& task);

  /// The tasks to look for in a picture of that time, in order of arrival. Those whose deadline has
  /// passed go; those issued later than the picture wait.
  std::vector<Task> open(Utime picture);

  /// Takes a look for a task; the outcome once it is decided, and then the task goes.
  std::optional<VerificationResult::Outcome> looked(std::int64_t task, const Sighting& sighting);

 private:
  struct Waiting {
    Task task;
    LookSeries series;
  };
  std::deque<Waiting>::iterator find(std::int64_t task);

  std::string robot_, sensor_;
  int dims_, looks_;
  std::mutex mutex_;
  std::deque<Waiting> waiting_;
};

}  // namespace anchord
