#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "maintenance/coordinator.h"
#include "maintenance/roi.h"

namespace anchord {
namespace {

constexpr double kLeastExistence = 0.1;  // of what the coordinator sets out for by itself

std::string number(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

std::string why(const Action& action, const Maintenance& settings) {
  return std::string(settings.planner == Maintenance::Planner::kGreedy ? "greedy" : "lookahead") +
         ": gain " + number(action.gain) + " nat over " + number(action.distance) + " m, utility " +
         number(action.utility) + " (of " + std::to_string(action.considered) + " compared)";
}

void fill_in(Task& task, const Action& action) {
  task.sensor = action.sensor;
  task.viewpoint = action.viewpoint.pose();
  task.gain_nat = action.gain;
  task.cost = action.cost;
  task.utility = action.utility;
}

}  // namespace

/// What next() reads of the belief, once and only if something is to be issued.
class Coordinator::Reading {
 public:
  Reading(const Belief& belief, Utime at, const Background& background)
      : background_(background),
        objects_(read_objects(belief, std::max(at, belief.utime), 0, background)) {}

  const ObjectBelief* find(const std::string& id) const {
    const auto found = std::find_if(objects_.begin(), objects_.end(), [&](const auto& object) {
      return object.anchor->is_called(id) && !object.versions.empty();
    });
    return found == objects_.end() ? nullptr : &*found;
  }

  const std::vector<ObjectBelief>& objects() const { return objects_; }

  void describe(Task& task, const ObjectBelief& object, Utime now) const {
    const Leaf& shown = object.shown();
    const ObjectClass& object_class = background_.object_class(shown.top_class());
    task.object = object.anchor->id();
    task.object_class = object_class.name;
    task.extent = {object_class.extent.x(), object_class.extent.y(), object_class.extent.z()};
    task.regions = regions_of(object, background_);
    task.appearance = appearance_of(object, background_);
    task.state = Task::State::kIssued;
    task.issued = now;
  }

 private:
  const Background& background_;
  const std::vector<ObjectBelief> objects_;
};

bool Coordinator::busy(const std::string& robot) const {
  return std::any_of(active_.begin(), active_.end(), [&](const auto& entry) {
    return entry.second.state == Task::State::kIssued && entry.second.robot == robot;
  });
}

/// Issues a triggered task to the robot that looks best, else to the first; null: to nobody.
const RobotPose* Coordinator::issue_triggered(Task& task, const ObjectBelief& object,
                                              const Reading& reading,
                                              const std::vector<const RobotPose*>& robots,
                                              Utime now) {
  reading.describe(task, object, now);
  task.sensor = task.wanted_sensor;
  if (robots.empty()) return nullptr;
  const std::vector<Subject> subject{subject_of(object, *background_)};
  const RobotPose* chosen = robots.front();
  std::optional<Action> best;
  for (const RobotPose* robot : robots)
    if (auto action = choose_for(0, task.wanted_sensor, subject, *robot, site_);
        action && (!best || action->utility > best->utility)) {
      best = std::move(action);
      chosen = robot;
    }
  task.robot = chosen->robot;
  if (best) fill_in(task, *best);
  return chosen;
}

/// Takes the coordinator's own task from a robot, for a planner's: what became of it.
std::optional<Task> Coordinator::make_way(const std::string& robot, Utime now) {
  for (const auto& [id, task] : active_)
    if (task.state == Task::State::kIssued && task.robot == robot && !task.triggered &&
        !in_hand_.contains(id))
      return finish(id, Task::State::kCancelled, now, "a planner's trigger came first");
  return std::nullopt;
}

std::optional<Task> Coordinator::own_choice(const Reading& reading, const RobotPose& robot,
                                            Utime now) {
  std::set<std::string> taken;
  for (const auto& [id, task] : active_) taken.insert(task.object);
  std::erase_if(aside_, [&](const auto& entry) { return entry.second <= now; });
  std::vector<Subject> subjects;
  std::vector<const ObjectBelief*> objects;
  for (const ObjectBelief& object : reading.objects()) {
    // What a robot holds need not be looked for.
    if (object.p < kLeastExistence || object.anchor->holder) continue;
    subjects.push_back(subject_of(object, *background_));
    subjects.back().target =
        !taken.contains(subjects.back().id) && !aside_.contains(subjects.back().id);
    objects.push_back(&object);
  }
  const auto action = choose(subjects, robot, site_, limits_);
  if (!action) return std::nullopt;
  Task task;
  task.id = ++last_id_;
  task.robot = robot.robot;
  task.created = now;
  // The way there counts in, twice: what a plan takes is an estimate.
  task.deadline = now + from_seconds(site_.settings.timeout + 2 * action->duration);
  reading.describe(task, *objects[static_cast<std::size_t>(action->subject)], now);
  fill_in(task, *action);
  task.reason = why(*action, site_.settings);
  return active_[task.id] = task;
}

std::vector<Task> Coordinator::next(Utime now, const Belief& belief,
                                    const std::vector<RobotPose>& robots) {
  std::vector<Task> changed;
  std::optional<Reading> reading;
  const auto read = [&]() -> const Reading& {
    if (!reading) reading.emplace(belief, now, *background_);
    return *reading;
  };
  std::vector<const RobotPose*> free;
  for (const RobotPose& robot : robots)
    if (!busy(robot.robot)) free.push_back(&robot);
  std::vector<std::int64_t> waiting;  // in order of arrival
  for (const auto& [id, task] : active_)
    if (task.state == Task::State::kQueued) waiting.push_back(id);
  for (const std::int64_t id : waiting) {
    Task& task = active_.at(id);
    const auto fits = [&](const RobotPose& robot) {
      return task.robot.empty() || robot.robot == task.robot;
    };
    std::vector<const RobotPose*> candidates;
    for (const RobotPose* robot : free)
      if (fits(*robot)) candidates.push_back(robot);
    const bool known = std::any_of(robots.begin(), robots.end(), fits);
    if (candidates.empty() && !known && busy(task.robot)) continue;
    const ObjectBelief* object = read().find(task.object);
    if (!object) {
      changed.push_back(finish(id, Task::State::kCancelled, now, "there is no such object now"));
      continue;
    }
    for (const RobotPose& robot : robots) {
      if (!candidates.empty()) break;
      if (!fits(robot)) continue;
      if (auto own = make_way(robot.robot, now)) {
        changed.push_back(std::move(*own));
        candidates.push_back(&robot);
      }
    }
    if (candidates.empty() && known) continue;
    const RobotPose* robot = issue_triggered(task, *object, read(), candidates, now);
    std::erase(free, robot);
    changed.push_back(task);
  }
  if (!site_.settings.enabled || site_.eyes.empty()) return changed;
  for (const RobotPose* robot : free)
    if (auto task = own_choice(read(), *robot, now)) changed.push_back(std::move(*task));
  return changed;
}

}  // namespace anchord
