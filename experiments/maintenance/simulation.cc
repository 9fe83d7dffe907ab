#include "experiments/maintenance/simulation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/maintenance/believer.h"
#include "experiments/maintenance/robot.h"

namespace anchord::experiment {
namespace {

/// What the robot is about.
struct Errand {
  int eye = 0;
  double dwell = 0;  ///< s that are left to look after the arrival
};

Site site_of(const Scene& scene) {
  Site site(scene.knowledge);
  if (scene.approach > 0)
    for (Eye& eye : site.eyes) eye.ranges = {scene.approach};
  return site;
}

class Simulation {
 public:
  Simulation(Scene scene, const Strategy& strategy, const Span& span, std::uint64_t seed)
      : scene_(std::move(scene)),
        strategy_(strategy),
        span_(span),
        site_(site_of(scene_)),
        robot_(scene_.start),
        nature_(2 * seed),
        senses_(2 * seed + 1),
        believer_(scene_.engine ? engine_believer(scene_, site_, nature_)
                                : kalman_believer(scene_, site_, nature_)) {
    outcome_.updated.assign(scene_.things.size(), 0);
    outcome_.approached.assign(scene_.things.size(), 0);
  }

  Outcome run() {
    const int steps = static_cast<int>(std::lround(span_.length / span_.step));
    int counted = 0;
    for (int k = 1; k <= steps; ++k) {
      counts_ = (k - 1) * span_.step >= span_.warm_up;
      if (!errand_) decide((k - 1) * span_.step);
      const double time = k * span_.step;
      move_things();
      go(time);
      if (!counts_ || k % span_.sample != 0) continue;
      ++counted;
      const Entropies h = believer_->entropies(time);
      outcome_.h_max += h.max;
      outcome_.h_sum += h.sum;
      outcome_.lost += lost(believer_->subjects(time));
    }
    outcome_.lost /= counted;
    outcome_.h_max /= counted;
    outcome_.h_sum /= counted;
    return outcome_;
  }

 private:
  void decide(double time) {
    const std::vector<Subject> subjects = believer_->subjects(time);
    if (strategy_.kind == Strategy::Kind::kTour) return tour(subjects);
    if (strategy_.kind == Strategy::Kind::kPatrol) return patrol();
    const auto action = strategy_.kind == Strategy::Kind::kPlanner
                            ? choose(subjects, robot_.pose(), site_, strategy_.limits)
                            : choose_against_present(subjects);
    if (!action) return;
    const auto eye =
        std::find(site_.sensor_names.begin(), site_.sensor_names.end(), action->sensor);
    begin(static_cast<int>(eye - site_.sensor_names.begin()), action->way, action->viewpoint);
    count(subjects[static_cast<std::size_t>(action->subject)], action->cost);
  }

  void tour(const std::vector<Subject>& subjects) {
    if (rests_ > 0) return;
    const Eye& eye = site_.eyes[static_cast<std::size_t>(strategy_.eye)];
    for (std::size_t tries = 0; tries < subjects.size(); ++tries) {
      const Subject& subject = subjects[next_++ % subjects.size()];
      const auto base = viewpoint_of(subject.mean(), eye, robot_.base(), site_);
      if (!base) continue;
      const Way way = site_.ways.way(site_.ways.start(robot_.base().position), base->position);
      if (!std::isfinite(way.length)) continue;
      begin(strategy_.eye, way, *base);
      count(subject, way.length / site_.settings.cost_scale + eye.cost);
      return;
    }
  }

  void patrol() {
    BasePose end = robot_.base();
    if (rests_ > 0) {
      rests_ -= span_.step;
      end.yaw += 3.141592653589793 / 2;
    } else {
      end.position = scene_.patrol[next_++ % scene_.patrol.size()];
      rests_ = strategy_.pause;
    }
    begin(strategy_.eye, site_.ways.way(site_.ways.start(robot_.base().position), end.position),
          end);
  }

  /// Thesis section 3.5.3 with the gain counted from the present entropy.
  std::optional<Action> choose_against_present(const std::vector<Subject>& subjects) const {
    std::optional<Action> best;
    Forecast forecast(subjects, site_);
    const WayMap::Start start = site_.ways.start(robot_.base().position);
    for (const Viewpoint& viewpoint :
         viewpoints(subjects, robot_.base(), 0, strategy_.limits.targets, site_)) {
      const Way way = site_.ways.way(start, viewpoint.base.position);
      Course course;
      follow(way, viewpoint, 0, site_, course);
      for (const Glance& look : course.looks) forecast.look(look);
      double gain = 0;
      for (const int i : forecast.seen())
        gain += forecast.entropies(i, 0).without - forecast.entropies(i, course.end).with;
      forecast.reset();
      const double cost = way.length / site_.settings.cost_scale;
      const double utility = gain / site_.settings.gain_norm - site_.settings.omega * cost;
      if (!(gain > site_.settings.threshold) || (best && !(utility > best->utility))) continue;
      best.emplace();
      best->subject = viewpoint.subject;
      best->sensor = site_.sensor_names[static_cast<std::size_t>(viewpoint.eye)];
      best->viewpoint = viewpoint.base;
      best->cost = cost;
      best->utility = utility;
      best->way = way;
    }
    return best;
  }

  void begin(int eye, const Way& way, const BasePose& end) {
    errand_ = Errand{eye, site_.eyes[static_cast<std::size_t>(eye)].dwell};
    robot_.set_out(way, end);
  }

  void count(const Subject& subject, double cost) {
    if (!counts_) return;
    ++outcome_.actions;
    outcome_.cost += cost;
    const Eigen::Vector2d mean = subject.mean().head<2>();
    const auto away = [&](const Thing& thing) { return (thing.position - mean).squaredNorm(); };
    const auto nearest =
        std::min_element(scene_.things.begin(), scene_.things.end(),
                         [&](const Thing& a, const Thing& b) { return away(a) < away(b); });
    ++outcome_.approached[static_cast<std::size_t>(nearest - scene_.things.begin())];
  }

  double lost(const std::vector<Subject>& subjects) const {
    int n = 0;
    for (const Thing& thing : scene_.things)
      n += std::none_of(subjects.begin(), subjects.end(), [&](const Subject& subject) {
        return subject.p >= 0.5 && (subject.mean().head<2>() - thing.position).norm() < 1;
      });
    return static_cast<double>(n) / static_cast<double>(scene_.things.size());
  }

  void move_things() {
    for (Thing& thing : scene_.things) {
      if (scene_.wanders) {
        const double spread = std::sqrt(thing.psd * span_.step);
        const double dx = spread * nature_.normal();
        const Eigen::Vector2d to = thing.position + Eigen::Vector2d(dx, spread * nature_.normal());
        for (const Rectangle& room : scene_.rooms)
          if (room.contains(thing.position) && room.contains(to)) thing.position = to;
      }
      if (scene_.jump_rate > 0 && nature_.happens(scene_.jump_rate * span_.step)) {
        const double room = nature_.uniform(0, static_cast<double>(scene_.rooms.size()));
        thing.position = scene_.rooms[static_cast<std::size_t>(room)].draw(nature_);
      }
    }
  }

  /// One time step of driving and looking.
  void go(double time) {
    if (!errand_) {
      rests_ -= span_.step;
      if (strategy_.looks_idle) look(0, time);
      return;
    }
    const bool was_there = robot_.arrived();
    const double driven = robot_.drive(site_.settings.speed * span_.step);
    if (counts_) outcome_.distance += driven;
    look(errand_->eye, time);
    if (!robot_.arrived()) return;
    if (was_there) errand_->dwell -= span_.step;
    if (errand_->dwell > 1e-9) return;
    errand_.reset();
    if (strategy_.kind == Strategy::Kind::kTour) rests_ = strategy_.pause;
  }

  void look(int eye_index, double time) {
    const Eye& eye = site_.eyes[static_cast<std::size_t>(eye_index)];
    const Sensor& sensor = scene_.knowledge.sensors[static_cast<std::size_t>(eye.sensor)];
    Look look{eye_index, robot_.base(), {}};
    const double spread = std::sqrt(eye.noise.front()(0, 0));  // the same in all directions
    for (std::size_t i = 0; i < scene_.things.size(); ++i) {
      const Thing& thing = scene_.things[i];
      const Eigen::Vector3d point(thing.position.x(), thing.position.y(), 0);
      const bool detected = senses_.happens(
          sensor.detection_probability[static_cast<std::size_t>(thing.object_class)].at(
              (point - site_.stance(eye, robot_.base()).sensor).norm()));
      const double ex = spread * senses_.normal(), ey = spread * senses_.normal();
      if (!detected || !site_.sees(eye, robot_.base(), point)) continue;
      look.seen.push_back(
          {static_cast<int>(i), thing.position + Eigen::Vector2d(ex, ey), thing.object_class});
      if (counts_) ++outcome_.updates, ++outcome_.updated[i];
    }
    if (scene_.engine) add_clutter(eye, sensor, look);
    believer_->take(look, time);
  }

  /// Poisson in the view, of the configured density, drawn in the square around it.
  void add_clutter(const Eye& eye, const Sensor& sensor, Look& look) {
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(eye.reach);
    const Rectangle square{look.base.position - half, look.base.position + half};
    const double expected = sensor.clutter_density * 4 * eye.reach * eye.reach;
    for (double p = senses_.uniform(); p > std::exp(-expected); p *= senses_.uniform()) {
      const Eigen::Vector2d at = square.draw(senses_);
      const int reported = static_cast<int>(
          senses_.uniform(0, static_cast<double>(scene_.knowledge.classes.size())));
      if (site_.sees(eye, look.base, {at.x(), at.y(), 0})) look.seen.push_back({-1, at, reported});
    }
  }

  Scene scene_;
  const Strategy strategy_;
  const Span span_;
  const Site site_;
  Robot robot_;
  Dice nature_, senses_;
  std::unique_ptr<Believer> believer_;
  std::optional<Errand> errand_;
  std::size_t next_ = 0;  ///< of the tour
  double rests_ = 0;      ///< s that the tour still rests
  bool counts_ = false;
  Outcome outcome_;
};

}  // namespace

Outcome simulate(Scene scene, const Strategy& strategy, const Span& span, std::uint64_t seed) {
  return Simulation(std::move(scene), strategy, span, seed).run();
}

}  // namespace anchord::experiment
