#include "maintenance/coordinator.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace anchord {
namespace {

/// What an announced action asks for.
Result<Maintenance::Verify> rule_for(const std::string& action, const Maintenance& settings) {
  for (const auto& rule : settings.actions)
    if (rule.action == action) return rule.verify;
  std::string known;
  for (const auto& rule : settings.actions) known += (known.empty() ? "" : ", ") + rule.action;
  return invalid("action", "no such action; the configuration knows: " +
                               (known.empty() ? std::string("none") : known));
}

Error unknown(std::int64_t id) {
  return {ErrorCode::kUnknown, "task", "there is no task " + std::to_string(id)};
}

Error conflict(std::int64_t id, const std::string& why) {
  return {ErrorCode::kConflict, "task", "task " + std::to_string(id) + " " + why};
}

}  // namespace

Coordinator::Coordinator(std::shared_ptr<const Background> background, const PlannerLimits& limits)
    : background_(std::move(background)), site_(background_->knowledge), limits_(limits) {}

Result<std::optional<Task>> Coordinator::add(const Trigger& trigger, const std::string& object,
                                             const std::string& object_class, Utime now) {
  const Maintenance& settings = site_.settings;
  if (!trigger.action.empty()) {
    const auto rule = rule_for(trigger.action, settings);
    if (!rule) return rule.error();
    if (*rule == Maintenance::Verify::kNothing) return std::optional<Task>();
  }
  if (!(trigger.timeout_s >= 0 && trigger.timeout_s <= kMaxTimeout))
    return invalid("timeout", "must be seconds from 0 (the configured time) to a million");
  if (!trigger.sensor.empty() && std::find(site_.sensor_names.begin(), site_.sensor_names.end(),
                                           trigger.sensor) == site_.sensor_names.end())
    return invalid("sensor",
                   "no sensor of that name serves verification tasks (its "
                   "\"verification\" in the configuration says so)");
  const double timeout = trigger.timeout_s > 0 ? trigger.timeout_s : settings.timeout;
  const Utime deadline = now + from_seconds(timeout);
  if (Task* task = to_join(trigger, object, now)) {
    if (trigger.tag != 0) task->tags.push_back(trigger.tag);
    task->deadline = std::max(task->deadline, deadline);
    return std::optional<Task>(*task);
  }
  if (active_.size() >= kMaxActive)
    return Error{ErrorCode::kUnavailable, "",
                 std::to_string(kMaxActive) + " tasks wait or are issued already; try again later"};
  Task task;
  task.id = ++last_id_;
  task.triggered = true;
  if (trigger.tag != 0) task.tags = {trigger.tag};
  task.action = trigger.action;
  task.object = object;
  task.object_class = object_class;
  task.robot = trigger.robot;
  task.wanted_sensor = trigger.sensor;
  task.created = now;
  task.deadline = deadline;
  task.reason =
      trigger.action.empty() ? "a planner asked for it" : "a planner is about to " + trigger.action;
  active_[task.id] = task;
  return std::optional<Task>(std::move(task));
}

Task* Coordinator::to_join(const Trigger& trigger, const std::string& object, Utime now) {
  if (trigger.alone) return nullptr;
  for (auto& [id, task] : active_) {
    if (!task.triggered || task.object != object || task.deadline <= now) continue;
    if (in_hand_.contains(id)) continue;
    if (task.tags.size() >= kMaxTags) continue;
    const bool robot = trigger.robot.empty() || trigger.robot == task.robot;
    const bool sensor = trigger.sensor.empty() || trigger.sensor == task.wanted_sensor ||
                        trigger.sensor == task.sensor;
    if (robot && sensor) return &task;
  }
  return nullptr;
}

Result<Task> Coordinator::cancel(std::int64_t id, Utime now) {
  if (!active_.contains(id)) {
    if (find(id)) return conflict(id, "has ended already");
    return unknown(id);
  }
  if (in_hand_.contains(id)) return conflict(id, "has a result that is being written");
  Task task = finish(id, Task::State::kCancelled, now, "it was cancelled");
  if (!task.triggered) leave_aside(task.object, now);
  return task;
}

Result<TaskEnd> Coordinator::check(const VerificationResult& result, Utime now) const {
  const auto found = active_.find(result.task);
  if (found == active_.end()) {
    if (find(result.task)) return conflict(result.task, "has ended already");
    return unknown(result.task);
  }
  if (in_hand_.contains(result.task))
    return conflict(result.task, "has a result that is being written");
  TaskEnd end{found->second, {}, {}};
  Task& task = end.task;
  if (task.state == Task::State::kQueued)
    return conflict(task.id, "was not issued yet: nobody was asked to look");
  if (task.deadline <= now) return conflict(task.id, "is past its deadline");
  task.ended = now;
  switch (result.outcome) {
    case VerificationResult::Outcome::kFound: {
      if (!result.frame) return invalid("frame", "is missing: what was found, and where");
      if (result.frame->detections.size() != 1)
        return invalid("frame.detections", "must be one, that of the object");
      end.frame = result.frame;
      std::string& named = end.frame->detections.front().object;
      if (named.empty()) named = task.object;
      if (named != task.object)
        return invalid("frame.detections[0].object", "must be the task's, " + task.object);
      task.state = Task::State::kFound;
      task.reason = "it was found";
      break;
    }
    case VerificationResult::Outcome::kMissing: {
      if (result.utime < kEarliestUtime || result.utime > kLatestUtime)
        return invalid("utime", "must lie in the years 2000 to 2100: the time of the look");
      Event event;
      event.kind = Event::Kind::kMissing;
      event.utime = result.utime;
      event.robot = result.robot.empty() ? task.robot : result.robot;
      event.sensor = result.sensor.empty() ? task.sensor : result.sensor;
      event.object = task.object;
      event.regions = task.regions;
      end.event = std::move(event);
      task.state = Task::State::kMissing;
      task.reason = "it was not where it was looked for";
      break;
    }
    case VerificationResult::Outcome::kOccluded:
      task.state = Task::State::kOccluded;
      task.reason = "something was in front of it";
      break;
  }
  return end;
}

void Coordinator::end(const TaskEnd& end) {
  in_hand_.erase(end.task.id);
  if (active_.contains(end.task.id))
    finish(end.task.id, end.task.state, end.task.ended, end.task.reason);
}

std::vector<Task> Coordinator::expire(Utime now) {
  std::vector<std::int64_t> due;
  for (const auto& [id, task] : active_)
    if (task.deadline <= now && !in_hand_.contains(id)) due.push_back(id);
  std::vector<Task> changed;
  for (const std::int64_t id : due) {
    const bool issued = active_.at(id).state == Task::State::kIssued;
    changed.push_back(finish(id, Task::State::kExpired, now,
                             issued ? "nobody answered in time" : "its turn did not come in time"));
  }
  return changed;
}

/// Nobody sets out again at once for what cannot be seen or reached now.
void Coordinator::leave_aside(const std::string& object, Utime now) {
  aside_[object] = now + from_seconds(site_.settings.timeout);
}

Task Coordinator::finish(std::int64_t id, Task::State state, Utime now, std::string reason) {
  Task task = std::move(active_.at(id));
  active_.erase(id);
  task.state = state;
  task.ended = now;
  task.reason = std::move(reason);
  if (!task.triggered && state != Task::State::kFound && state != Task::State::kCancelled)
    leave_aside(task.object, now);
  ended_.push_back(task);
  if (ended_.size() > kMaxEnded) ended_.pop_front();
  return task;
}

void Coordinator::restore(std::vector<Task> tasks) {
  std::sort(tasks.begin(), tasks.end(), [](const Task& a, const Task& b) {
    return a.ended != b.ended ? a.ended < b.ended : a.id < b.id;
  });
  for (Task& task : tasks) {
    last_id_ = std::max(last_id_, task.id);
    if (!task.ended_already()) {
      active_[task.id] = std::move(task);
      continue;
    }
    ended_.push_back(std::move(task));
    if (ended_.size() > kMaxEnded) ended_.pop_front();
  }
}

const Task* Coordinator::find(std::int64_t id) const {
  if (const auto found = active_.find(id); found != active_.end()) return &found->second;
  const auto found =
      std::find_if(ended_.begin(), ended_.end(), [id](const Task& task) { return task.id == id; });
  return found == ended_.end() ? nullptr : &*found;
}

std::vector<Task> Coordinator::tasks() const {
  std::vector<Task> all = open_tasks();
  all.insert(all.end(), ended_.begin(), ended_.end());
  std::sort(all.begin(), all.end(), [](const Task& a, const Task& b) { return a.id < b.id; });
  return all;
}

std::vector<Task> Coordinator::open_tasks() const {
  std::vector<Task> open;
  for (const auto& [id, task] : active_) open.push_back(task);
  return open;
}

}  // namespace anchord
