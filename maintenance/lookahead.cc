#include "maintenance/lookahead.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace anchord {
namespace {

/// The first leg of a plan.
struct Leg {
  Viewpoint viewpoint;
  Course course;
  Way way;
  double gain = 0, cost = 0;
};

/// A sequence of viewpoints, and what comes of it, but for the forecast.
struct Outcome {
  BasePose base;
  double time = 0;      ///< s when it is over
  double cost = 0;      ///< of all its viewpoints
  double gain = 0;      ///< nat, at `time`
  double integral = 0;  ///< nat s: of the gain until `time`
  double worth = 0;     ///< U
  int legs = 0;
  std::shared_ptr<const Leg> first;
};
struct Plan : Outcome {
  Forecast forecast;
};

class Lookahead {
 public:
  Lookahead(const std::vector<Subject>& subjects, const BasePose& from, const Site& site,
            const PlannerLimits& limits)
      : subjects_(subjects),
        site_(site),
        limits_(limits),
        viewpoints_(viewpoints(subjects, from, limits.shared_viewpoints, limits.targets, site)),
        span_(site.settings.horizon * site.settings.cost_scale / (2 * site.settings.speed)) {}

  std::optional<Action> run(const BasePose& from) {
    std::vector<Plan> beam{{{from, 0, 0, 0, 0, 0, 0, nullptr}, Forecast(subjects_, site_)}};
    set_chances(beam.front().forecast);
    std::optional<Outcome> best;
    for (int depth = 0; depth < site_.settings.horizon && !beam.empty(); ++depth) {
      std::vector<Plan> next;
      for (const Plan& plan : beam) extend(plan, next);
      for (const Plan& plan : next)
        if (plan.worth > 0 && plan.gain > site_.settings.threshold * plan.legs &&
            (!best || plan.worth > best->worth))
          best = plan;
      beam = std::move(next);
    }
    if (!best) return std::nullopt;
    const Leg& leg = *best->first;
    const Viewpoint& viewpoint = leg.viewpoint;
    return Action{viewpoint.subject,
                  subjects_[static_cast<std::size_t>(viewpoint.subject)].id,
                  site_.sensor_names[static_cast<std::size_t>(viewpoint.eye)],
                  viewpoint.base,
                  leg.gain,
                  leg.cost,
                  best->worth,
                  leg.course.length,
                  leg.course.end,
                  leg.course.looks,
                  leg.way,
                  considered_};
  }

 private:
  /// What each viewpoint would gain if the robot stood there now.
  void set_chances(Forecast forecast) {
    for (const Viewpoint& viewpoint : viewpoints_) {
      forecast.look({viewpoint.eye, viewpoint.base, 0});
      chances_.emplace_back();
      for (const int subject : forecast.seen())
        chances_.back().emplace_back(subject, forecast.gain_of(subject, 0));
      forecast.reset();
    }
  }

  /// The viewpoints that a plan may go on to: those of which the most is hoped for the way.
  std::vector<int> branches(const Plan& plan, const WayMap::Start& start) const {
    std::vector<std::pair<double, int>> hopes;
    const double per_metre =
        site_.settings.omega * site_.settings.gain_norm / site_.settings.cost_scale;
    for (std::size_t i = 0; i < viewpoints_.size(); ++i) {
      double hope = 0;
      for (const auto& [subject, gain] : chances_[i])
        if (!plan.forecast.sees(subject)) hope += gain;
      if (hope <= 0) continue;
      const Viewpoint& viewpoint = viewpoints_[i];
      if (!site_.eyes[static_cast<std::size_t>(viewpoint.eye)].moves_base && plan.legs > 0)
        continue;  // whether it sees the object from elsewhere is not known
      const double length = site_.ways.length(start, viewpoint.base.position);
      if (!std::isfinite(length)) continue;
      const double late = std::min(1.0, (plan.time + length / site_.settings.speed) / span_);
      hopes.emplace_back(hope * (1 - late) - per_metre * length, static_cast<int>(i));
    }
    const auto keep = std::min(hopes.size(), static_cast<std::size_t>(limits_.branches));
    std::partial_sort(hopes.begin(), hopes.begin() + static_cast<std::ptrdiff_t>(keep), hopes.end(),
                      [](const auto& a, const auto& b) {
                        return a.first != b.first ? a.first > b.first : a.second < b.second;
                      });
    std::vector<int> out;
    for (std::size_t i = 0; i < keep; ++i) out.push_back(hopes[i].second);
    return out;
  }

  /// Puts the continuations of a plan among the best so far.
  void extend(const Plan& plan, std::vector<Plan>& best) {
    const WayMap::Start start = site_.ways.start(plan.base.position);
    Plan work = plan;
    for (const int i : branches(plan, start)) {
      Viewpoint viewpoint = viewpoints_[static_cast<std::size_t>(i)];
      const Eye& eye = site_.eyes[static_cast<std::size_t>(viewpoint.eye)];
      if (plan.legs > 0 && !viewpoint.shared) {
        // From another side than where the robot is now.
        const auto base = viewpoint_of(
            subjects_[static_cast<std::size_t>(viewpoint.subject)].mean(), eye, plan.base, site_);
        if (base) viewpoint.base = *base;
      }
      const Way way = site_.ways.way(start, viewpoint.base.position);
      if (!std::isfinite(way.length)) continue;
      ++considered_;
      follow(way, viewpoint, plan.time, site_, course_);
      static_cast<Outcome&>(work) = plan;
      work.forecast.back_to(plan.forecast);
      for (const Glance& look : course_.looks) work.forecast.look(look);
      const double cost = way.length / site_.settings.cost_scale + eye.cost;
      finish(work, viewpoint.base, cost);
      if (static_cast<int>(best.size()) == limits_.beam && !(work.worth > best.back().worth))
        continue;
      if (plan.legs == 0)
        work.first = std::make_shared<Leg>(Leg{viewpoint, course_, way, work.gain, cost});
      if (static_cast<int>(best.size()) == limits_.beam) best.pop_back();
      const auto place = std::find_if(best.begin(), best.end(),
                                      [&](const Plan& other) { return work.worth > other.worth; });
      best.insert(place, work);
    }
  }

  /// Counts what the last leg brought; the gain is taken to change evenly between its ends.
  void finish(Plan& plan, const BasePose& base, double cost) const {
    const double end = course_.end;
    const double gain = plan.forecast.gain(end);
    if (end >= span_) {
      const double part = (span_ - plan.time) / (end - plan.time);
      const double at_span = plan.gain + part * (gain - plan.gain);
      if (plan.time < span_) plan.integral += (plan.gain + at_span) / 2 * (span_ - plan.time);
    } else {
      plan.integral += (plan.gain + gain) / 2 * (end - plan.time);
    }
    plan.time = end;
    plan.gain = gain;
    plan.cost += cost;
    plan.base = base;
    ++plan.legs;
    double integral = plan.integral;
    if (end < span_) integral += (gain + plan.forecast.gain(span_)) / 2 * (span_ - end);
    plan.worth = integral / span_ / site_.settings.gain_norm - site_.settings.omega * plan.cost;
  }

  const std::vector<Subject>& subjects_;
  const Site& site_;
  const PlannerLimits limits_;
  const std::vector<Viewpoint> viewpoints_;
  std::vector<std::vector<std::pair<int, double>>> chances_;  ///< per viewpoint: subject, nat
  const double span_;                                         ///< T, s
  Course course_;
  int considered_ = 0;
};

}  // namespace

std::optional<Action> choose_lookahead(const std::vector<Subject>& subjects, const BasePose& from,
                                       const Site& site, const PlannerLimits& limits) {
  return Lookahead(subjects, from, site, limits).run(from);
}

}  // namespace anchord
