#include "daemon/verifications.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "anchoring/reading.h"
#include "api/http_message.h"
#include "api/parameters.h"

namespace anchord {
namespace {

/// How often it is decided anew, without a reason to do it earlier.
constexpr std::chrono::milliseconds kPeriod{250};
/// How far a robot goes before what it holds is put where it is; no more often than that.
constexpr double kCarriedAlong = 0.1;  // m
/// How often what is issued is told again: whoever looks may have come later, or missed it.
constexpr std::chrono::seconds kTellAgain{5};
/// Acknowledgements that may wait; beyond that the journal's thread waits.
constexpr std::size_t kAcknowledgements = 4096;
constexpr char kOrigin[] = "verification";

double distance(const Pose& a, const Pose& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += (a.position[i] - b.position[i]) * (a.position[i] - b.position[i]);
  return std::sqrt(sum);
}

bool holds_anything(const Belief& belief, const std::string& robot) {
  for (const auto& cluster : belief.clusters)
    for (const AnchorTree& tree : cluster->anchors)
      if (tree.anchor->holder == robot) return true;
  return false;
}

}  // namespace

Verifications::Verifications(Journal& journal, Robots& robots, Publish publish)
    : journal_(journal),
      robots_(robots),
      publish_(std::move(publish)),
      coordinator_(journal.snapshot().background),
      since_(Clock::now()),
      acknowledgements_(kAcknowledgements) {}

Verifications::~Verifications() { stop(); }

Status Verifications::restore() {
  auto tasks = journal_.tasks();
  if (!tasks) return tasks.error();
  std::lock_guard lock(mutex_);
  coordinator_.restore(std::move(*tasks));
  return Done{};
}

void Verifications::start() {
  thread_ = std::thread([this] { run(); });
}

void Verifications::stop() {
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  acknowledgements_.stop();
}

/// Does what comes of a commit: on another thread, for deciding may take a while and frames must
/// not wait for it.
void Verifications::acknowledge(std::function<void()> task) {
  if (!acknowledgements_.post(task)) task();
}

/// With mutex_ held. World time never goes back.
Utime Verifications::now() {
  const Utime newest = journal_.snapshot().belief->utime;
  const auto clock = Clock::now();
  if (newest != newest_) {
    newest_ = newest;
    since_ = clock;
  }
  if (newest_ == 0) return last_now_;
  const auto gone = std::chrono::duration_cast<std::chrono::microseconds>(clock - since_).count();
  last_now_ = std::max(last_now_, newest_ + gone);
  return last_now_;
}

void Verifications::run() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    decide();
    tell_again();
    wake_.wait_for(lock, kPeriod, [&] { return ending_ || woken_; });
    woken_ = false;
  }
}

/// With mutex_ held.
void Verifications::decide() {
  std::vector<Task> changed;
  for (const std::int64_t id : std::exchange(unkept_, {}))
    if (const Task* task = coordinator_.find(id)) changed.push_back(*task);
  const Utime time = now();
  if (time == 0) return;  // nothing has been seen yet
  for (Task& task : coordinator_.expire(time)) changed.push_back(std::move(task));
  const auto snapshot = journal_.snapshot();
  for (Task& task : coordinator_.next(time, *snapshot.belief, robots_.all()))
    changed.push_back(std::move(task));
  if (!changed.empty()) keep(changed);
}

/// With mutex_ held.
void Verifications::tell_again() {
  if (Clock::now() - told_ < kTellAgain) return;
  told_ = Clock::now();
  for (const Task& task : coordinator_.tasks())
    if (task.state == Task::State::kIssued) publish_(task, now());
}

/// With mutex_ held: hands changed tasks to the log, and publishes them when it has them.
void Verifications::keep(const std::vector<Task>& tasks) {
  Submission submission{{}, kOrigin, false, {}};
  submission.tasks = tasks;
  submission.done = [this, tasks](const Result<Receipt>& receipt) {
    acknowledge([this, tasks, kept = receipt.ok()] {
      std::lock_guard lock(mutex_);
      for (const Task& task : tasks)
        if (kept)
          publish_(task, now());
        else
          unkept_.insert(task.id);
    });
  };
  if (journal_.submit(std::move(submission))) return;
  for (const Task& task : tasks) unkept_.insert(task.id);
}

/// Id and class of the object that a trigger means.
Result<std::pair<std::string, std::string>> Verifications::meant(const Trigger& trigger) const {
  if (trigger.object.empty() == trigger.description.empty())
    return invalid("object", "name the object by its id, or describe it, and not both");
  const auto snapshot = journal_.snapshot();
  Description description;
  if (!trigger.description.empty()) {
    const auto target = parse_target("/v1/verifications?" + trigger.description);
    if (!target) return invalid("description", target.error().message);
    const auto parameters = read_parameters(*target, "description", *snapshot.background);
    if (!parameters)
      return invalid("description." + parameters.error().field, parameters.error().message);
    description = parameters->description;
  }
  const auto objects =
      read_objects(*snapshot.belief, snapshot.belief->utime, 0.001, *snapshot.background);
  const ObjectBelief* best = nullptr;
  double best_p = 0;
  for (const ObjectBelief& object : objects) {
    if (trigger.description.empty() && !object.anchor->is_called(trigger.object)) continue;
    const double p = object.p * match(object, description, *snapshot.background);
    if (!best || p > best_p) best = &object, best_p = p;
  }
  if (!best || (best_p <= 0 && !trigger.description.empty()))
    return Error{ErrorCode::kUnknown, trigger.description.empty() ? "object" : "description",
                 trigger.description.empty() ? "no object is called '" + trigger.object + "'"
                                             : "nothing that is known fits it"};
  const Leaf& leaf = best->shown();
  return std::pair(best->anchor->id(), snapshot.background->object_class(leaf.top_class()).name);
}

void Verifications::trigger(const Trigger& trigger, TaskDone done) {
  if (!done) done = [](const Result<std::optional<Task>>&) {};
  const auto object = meant(trigger);
  if (!object) return done(object.error());
  std::unique_lock lock(mutex_);
  const std::int64_t last = coordinator_.last_id();
  const auto added = coordinator_.add(trigger, object->first, object->second, now());
  if (!added || !*added) {
    lock.unlock();
    return done(added);
  }
  const std::int64_t id = (*added)->id;
  // With mutex_ held. A task that others wait for, too, is theirs still.
  const auto take_back = [this, id, is_new = id > last] {
    if (is_new) (void)coordinator_.cancel(id, now());
    unkept_.insert(id);
  };
  Submission submission{{}, kOrigin, false, {}};
  submission.tasks = {**added};
  submission.done = [this, id, done, take_back](const Result<Receipt>& receipt) {
    acknowledge([this, id, done, take_back, receipt] {
      std::unique_lock locked(mutex_);
      if (!receipt) {
        take_back();
        locked.unlock();
        return done(receipt.error());
      }
      const Task task = *coordinator_.find(id);
      if (!task.ended_already()) publish_(task, now());
      woken_ = true;
      locked.unlock();
      wake_.notify_one();
      done(std::optional<Task>(task));
    });
  };
  if (journal_.submit(std::move(submission))) return;
  take_back();
  lock.unlock();
  done(Error{ErrorCode::kUnavailable, "", "too much waits to be written; send this again"});
}

void Verifications::cancel(std::int64_t id, TaskDone done) {
  std::unique_lock lock(mutex_);
  const auto task = coordinator_.cancel(id, now());
  if (task) {
    keep({*task});
    woken_ = true;
  }
  lock.unlock();
  wake_.notify_one();
  if (done) done(task ? Result<std::optional<Task>>(std::optional<Task>(*task)) : task.error());
}

void Verifications::result(const VerificationResult& result, TaskDone done) {
  if (!done) done = [](const Result<std::optional<Task>>&) {};
  std::unique_lock lock(mutex_);
  const auto end = coordinator_.check(result, now());
  if (!end) {
    lock.unlock();
    return done(end.error());
  }
  coordinator_.take_in_hand(result.task);
  Submission submission{{}, kOrigin, false, {}};
  if (end->frame) submission.frames.push_back(*end->frame);
  if (end->event) submission.events.push_back(*end->event);
  submission.tasks = {end->task};
  submission.done = [this, end = *end, done](const Result<Receipt>& receipt) {
    acknowledge([this, end, done, receipt] {
      std::unique_lock locked(mutex_);
      if (!receipt) {
        coordinator_.put_back(end.task.id);
        locked.unlock();
        return done(receipt.error());
      }
      coordinator_.end(end);
      publish_(end.task, now());
      woken_ = true;
      locked.unlock();
      wake_.notify_one();
      done(std::optional<Task>(end.task));
    });
  };
  if (journal_.submit(std::move(submission))) return;
  coordinator_.put_back(result.task);
  lock.unlock();
  done(Error{ErrorCode::kUnavailable, "", "too much waits to be written; send this again"});
}

Status Verifications::pose(const RobotPose& pose) {
  if (Status set = robots_.set(pose); !set) return set;
  carry(pose);
  return Done{};
}

/// What the robot holds goes with it.
void Verifications::carry(const RobotPose& pose) {
  const auto snapshot = journal_.snapshot();
  std::lock_guard lock(carrying_);
  if (!holds_anything(*snapshot.belief, pose.robot)) {
    carried_.erase(pose.robot);
    return;
  }
  const auto last = carried_.find(pose.robot);
  if (last != carried_.end() && distance(last->second.pose, pose.pose) < kCarriedAlong) return;
  Event event;
  event.kind = Event::Kind::kCarried;
  event.utime = std::max(pose.utime, snapshot.belief->utime);
  event.robot = pose.robot;
  event.position = pose.pose.position;
  Submission submission{{}, kOrigin, false, {}};
  submission.events = {std::move(event)};
  if (journal_.submit(std::move(submission))) carried_[pose.robot] = pose;
}

std::vector<Task> Verifications::tasks() const {
  std::lock_guard lock(mutex_);
  return coordinator_.tasks();
}

std::vector<Task> Verifications::open_tasks() const {
  std::lock_guard lock(mutex_);
  return coordinator_.open_tasks();
}

std::optional<Task> Verifications::find(std::int64_t id) const {
  std::lock_guard lock(mutex_);
  const Task* task = coordinator_.find(id);
  return task ? std::optional(*task) : std::nullopt;
}

std::pair<std::size_t, std::size_t> Verifications::open() const {
  std::size_t queued = 0, issued = 0;
  for (const Task& task : open_tasks()) {
    queued += task.state == Task::State::kQueued;
    issued += task.state == Task::State::kIssued;
  }
  return {queued, issued};
}

}  // namespace anchord
