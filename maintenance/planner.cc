#include "maintenance/planner.h"

#include <cmath>

#include "maintenance/lookahead.h"

namespace anchord {
namespace {

/// Finds the viewpoint of greatest utility with a gain above `threshold`.
class Greedy {
 public:
  Greedy(const std::vector<Subject>& subjects, const BasePose& from, const Site& site)
      : subjects_(subjects),
        from_(from),
        site_(site),
        start_(site.ways.start(from.position)),
        forecast_(subjects, site) {}

  void consider(const Viewpoint& viewpoint, double threshold) {
    const Way way = site_.ways.way(start_, viewpoint.base.position);
    if (!std::isfinite(way.length)) return;
    ++considered_;
    follow(way, viewpoint, 0, site_, course_);
    for (const Glance& look : course_.looks) forecast_.look(look);
    const double gain = forecast_.gain(course_.end);
    forecast_.reset();
    if (!(gain > threshold)) return;
    const Maintenance& settings = site_.settings;
    const double cost =
        way.length / settings.cost_scale + site_.eyes[static_cast<std::size_t>(viewpoint.eye)].cost;
    const double utility = gain / settings.gain_norm - settings.omega * cost;
    if (best_ && !(utility > best_->utility)) return;
    best_ = Action{viewpoint.subject,
                   subjects_[static_cast<std::size_t>(viewpoint.subject)].id,
                   site_.sensor_names[static_cast<std::size_t>(viewpoint.eye)],
                   viewpoint.base,
                   gain,
                   cost,
                   utility,
                   way.length,
                   course_.end,
                   course_.looks,
                   way,
                   0};
  }

  std::optional<Action> best() {
    if (best_) best_->considered = considered_;
    return std::move(best_);
  }

 private:
  const std::vector<Subject>& subjects_;
  const BasePose from_;
  const Site& site_;
  const WayMap::Start start_;
  Forecast forecast_;
  Course course_;
  std::optional<Action> best_;
  int considered_ = 0;
};

}  // namespace

std::optional<Action> choose(const std::vector<Subject>& subjects, const RobotPose& robot,
                             const Site& site, const PlannerLimits& limits) {
  const BasePose from = BasePose::of(robot.pose);
  if (site.settings.planner == Maintenance::Planner::kLookahead)
    return choose_lookahead(subjects, from, site, limits);
  Greedy greedy(subjects, from, site);
  for (const Viewpoint& viewpoint :
       viewpoints(subjects, from, limits.shared_viewpoints, limits.targets, site))
    greedy.consider(viewpoint, site.settings.threshold);
  return greedy.best();
}

std::optional<Action> choose_for(int subject, const std::string& sensor,
                                 const std::vector<Subject>& subjects, const RobotPose& robot,
                                 const Site& site) {
  const BasePose from = BasePose::of(robot.pose);
  Greedy greedy(subjects, from, site);
  const Eigen::Vector3d point = subjects[static_cast<std::size_t>(subject)].mean();
  for (std::size_t e = 0; e < site.eyes.size(); ++e) {
    if (!sensor.empty() && site.sensor_names[e] != sensor) continue;
    if (const auto base = viewpoint_of(point, site.eyes[e], from, site))
      greedy.consider({subject, static_cast<int>(e), *base},
                      -std::numeric_limits<double>::infinity());
  }
  return greedy.best();
}

}  // namespace anchord
