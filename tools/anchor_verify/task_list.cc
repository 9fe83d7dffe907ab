#include "task_list.h"

#include <algorithm>

#include "perception/task_check.h"

namespace anchord {

std::deque<TaskList::Waiting>::iterator TaskList::find(std::int64_t task) {
  return std::find_if(waiting_.begin(), waiting_.end(),
                      [&](const Waiting& each) { return each.task.id == task; });
}

Status TaskList::add(const Task& task) {
  const std::lock_guard lock(mutex_);
  const auto known = find(task.id);
  if (task.state != Task::State::kIssued || task.robot != robot_ || task.sensor != sensor_) {
    if (known != waiting_.end()) waiting_.erase(known);
    return Done{};
  }
  if (Status status = check_task(task, dims_); !status) return status;
  if (known != waiting_.end()) {
    known->task = task;  // told again: what was seen so far still counts
    return Done{};
  }
  if (waiting_.size() == kMostTasks) waiting_.pop_front();
  waiting_.push_back({task, LookSeries(looks_)});
  return Done{};
}

std::vector<Task> TaskList::open(Utime picture) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [&](const Waiting& each) {
    return each.task.deadline != 0 && each.task.deadline < picture;
  });
  std::vector<Task> tasks;
  for (const Waiting& each : waiting_) {
    if (each.task.issued <= picture) tasks.push_back(each.task);
  }
  return tasks;
}

std::optional<VerificationResult::Outcome> TaskList::looked(std::int64_t task,
                                                            const Sighting& sighting) {
  const std::lock_guard lock(mutex_);
  const auto known = find(task);
  if (known == waiting_.end()) return std::nullopt;  // cancelled while somebody looked
  const auto outcome = known->series.add(sighting);
  if (outcome) waiting_.erase(known);
  return outcome;
}

}  // namespace anchord
