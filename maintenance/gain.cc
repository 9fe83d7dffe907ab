#include "maintenance/gain.h"

#include <algorithm>
#include <cmath>

#include "maintenance/entropy.h"

namespace anchord {
namespace {

double plogp(double p) { return p > 0 ? p * std::log(p) : 0; }

Covariance blocks_of(const Kinematic& state) { return {state.pp, state.pv, state.vv}; }

}  // namespace

struct Forecast::Plan {
  std::vector<double> x, y, vx, vy;  ///< of tracks
  std::vector<int> owner;
  std::vector<const Subject::Track*> track;
  std::vector<double> log_weight;  ///< of tracks
  std::vector<double> tile_x, tile_y;
  std::vector<int> tile_owner;
  std::vector<const Subject::Tile*> tile;
  std::vector<int> first_track, first_tile;  ///< per subject, and the end
  std::vector<double> existence_entropy;     ///< per subject
};

/// A look, with what is the same for all that it may see.
struct Forecast::Sight {
  const Eye* eye;
  double time;
  Stance stance;

  Eigen::Matrix3d noise(int object_class) const {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() << stance.c, -stance.s, stance.s, stance.c;
    return turn * eye->noise[static_cast<std::size_t>(object_class)] * turn.transpose();
  }
};

Forecast::Forecast(const std::vector<Subject>& subjects, const Site& site)
    : subjects_(&subjects), site_(&site) {
  auto plan = std::make_shared<Plan>();
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    plan->first_track.push_back(static_cast<int>(plan->x.size()));
    plan->first_tile.push_back(static_cast<int>(plan->tile_x.size()));
    plan->existence_entropy.push_back(binary_entropy(subjects[i].p));
    for (const Subject::Track& track : subjects[i].tracks) {
      plan->x.push_back(track.state.position.x());
      plan->y.push_back(track.state.position.y());
      plan->vx.push_back(track.moves ? track.state.velocity.x() : 0);
      plan->vy.push_back(track.moves ? track.state.velocity.y() : 0);
      plan->owner.push_back(static_cast<int>(i));
      plan->track.push_back(&track);
      plan->log_weight.push_back(track.weight > 0 ? std::log(track.weight) : 0);
    }
    for (const Subject::Tile& tile : subjects[i].tiles) {
      plan->tile_x.push_back(tile.center.x());
      plan->tile_y.push_back(tile.center.y());
      plan->tile_owner.push_back(static_cast<int>(i));
      plan->tile.push_back(&tile);
    }
  }
  plan->first_track.push_back(static_cast<int>(plan->x.size()));
  plan->first_tile.push_back(static_cast<int>(plan->tile_x.size()));
  tracks_.resize(plan->x.size());
  tiles_.resize(plan->tile_x.size());
  rest_.resize(subjects.size());
  is_seen_.assign(subjects.size(), 0);
  plan_ = std::move(plan);
  for (int i = 0; i < this->subjects(); ++i) reset(i);
}

void Forecast::reset(int subject) {
  for (int j = plan_->first_track[subject]; j < plan_->first_track[subject + 1]; ++j) {
    tracks_[j].undetected = plan_->track[j]->weight;
    tracks_[j].detected = 0;
    tracks_[j].time = 0;
  }
  for (int k = plan_->first_tile[subject]; k < plan_->first_tile[subject + 1]; ++k)
    tiles_[k] = plan_->tile[k]->weight;
  rest_[subject] = {};
  is_seen_[subject] = 0;
}

void Forecast::reset() {
  for (const int subject : seen_) reset(subject);
  seen_.clear();
}

void Forecast::back_to(const Forecast& earlier) {
  for (const int subject : seen_) {
    const auto copy = [subject](const std::vector<int>& first, const auto& from, auto& to) {
      std::copy(from.begin() + first[subject], from.begin() + first[subject + 1],
                to.begin() + first[subject]);
    };
    copy(plan_->first_track, earlier.tracks_, tracks_);
    copy(plan_->first_tile, earlier.tiles_, tiles_);
    rest_[subject] = earlier.rest_[subject];
    is_seen_[subject] = earlier.is_seen_[subject];
  }
  seen_ = earlier.seen_;
}

void Forecast::touch(int subject) {
  if (is_seen_[subject]) return;
  is_seen_[subject] = 1;
  seen_.push_back(subject);
}

void Forecast::look(const Glance& look) {
  const Eye& eye = site_->eyes[static_cast<std::size_t>(look.eye)];
  const Sight sight{&eye, look.time, site_->stance(eye, look.base)};
  const Eigen::Vector3d from = sight.stance.sensor;
  const double reach2 = eye.reach * eye.reach;
  const Plan& plan = *plan_;
  for (std::size_t j = 0; j < plan.x.size(); ++j) {
    const double dx = plan.x[j] + plan.vx[j] * look.time - from.x();
    const double dy = plan.y[j] + plan.vy[j] * look.time - from.y();
    if (dx * dx + dy * dy <= reach2) see_track(static_cast<int>(j), sight);
  }
  for (std::size_t k = 0; k < plan.tile_x.size(); ++k) {
    const double dx = plan.tile_x[k] - from.x(), dy = plan.tile_y[k] - from.y();
    if (dx * dx + dy * dy <= reach2) see_tile(static_cast<int>(k), sight);
  }
}

Forecast::Branches Forecast::at(int j, double time, Rest& rest) const {
  const Subject::Track& track = *plan_->track[j];
  Branches out = tracks_[j];
  const double dt = time - out.time;
  if (track.leak > 0) {
    const double stays = std::exp(-track.leak * dt);
    rest.lost_undetected += out.undetected * (1 - stays);
    rest.lost_detected += out.detected * (1 - stays);
    out.undetected *= stays;
    out.detected *= stays;
  }
  if (out.detected > 0) out.covariance.predict(track.psd, track.moves, dt, site_->dims);
  out.time = time;
  return out;
}

void Forecast::see_track(int j, const Sight& sight) {
  const Subject::Track& track = *plan_->track[j];
  const int owner = plan_->owner[j];
  const Subject& subject = (*subjects_)[static_cast<std::size_t>(owner)];
  Eigen::Vector3d mean = track.state.position;
  if (track.moves) mean += sight.time * track.state.velocity;
  const double q = subject.detection_probability[static_cast<std::size_t>(sight.eye->sensor)].at(
      (mean - sight.stance.sensor).norm());
  if (!track.detectable || q <= 0) return;
  if (!site_->sees(*sight.eye, sight.stance, mean)) return;
  touch(owner);
  Rest& rest = rest_[owner];
  Branches& branches = tracks_[j] = at(j, sight.time, rest);
  const Eigen::Matrix3d noise = sight.noise(subject.top_class);
  if (branches.detected > 0) branches.covariance.update(noise, q, track.moves, site_->dims);
  const double moving = q * branches.undetected;
  if (moving <= 0) return;
  Covariance fresh = blocks_of(track.state);
  fresh.predict(track.psd, track.moves, sight.time, site_->dims);
  fresh.update(noise, 1, track.moves, site_->dims);
  branches.covariance = branches.detected > 0 ? Covariance::mean(branches.detected,
                                                                 branches.covariance, moving, fresh)
                                              : fresh;
  branches.detected += moving;
  branches.undetected -= moving;
  rest.class_gain += moving * subject.class_gain[static_cast<std::size_t>(sight.eye->sensor)];
}

void Forecast::see_tile(int k, const Sight& sight) {
  const int owner = plan_->tile_owner[k];
  const Subject& subject = (*subjects_)[static_cast<std::size_t>(owner)];
  const auto sensor = static_cast<std::size_t>(sight.eye->sensor);
  const double q = subject.detection_probability[sensor].at(
      (plan_->tile[k]->center - sight.stance.sensor).norm());
  const double moving = q * tiles_[k];
  if (moving <= 0 || !site_->sees(*sight.eye, sight.stance, plan_->tile[k]->center)) return;
  touch(owner);
  Rest& rest = rest_[owner];
  Covariance fresh{sight.noise(subject.top_class), Eigen::Matrix3d::Zero(),
                   Eigen::Matrix3d::Zero()};
  if (subject.found_moves)
    for (int i = 0; i < site_->dims; ++i) fresh.vv(i, i) = subject.initial_velocity_variance[i];
  if (rest.found > 0) {
    rest.covariance.predict(subject.found_psd, subject.found_moves, sight.time - rest.time,
                            site_->dims);
    fresh = Covariance::mean(rest.found, rest.covariance, moving, fresh);
  }
  rest.covariance = fresh;
  rest.time = sight.time;
  rest.found += moving;
  rest.class_gain += moving * subject.class_gain[sensor];
  tiles_[k] -= moving;
}

Forecast::Entropies Forecast::entropies(int i, double time) const {
  const Subject& subject = (*subjects_)[static_cast<std::size_t>(i)];
  const int dims = site_->dims;
  Rest rest = rest_[i];
  // Per branch the sum of m (H - ln m) over its components, and the sum of m.
  double undetected = 0, undetected_sum = 0, detected = 0, detected_sum = 0;
  double without = 0, lost = 0;  // the same, had nobody looked
  const auto add_undetected = [&](double mass, double h) {
    if (mass <= 0) return;
    undetected += mass;
    undetected_sum += mass * (h - std::log(mass));
  };
  for (int j = plan_->first_track[i]; j < plan_->first_track[i + 1]; ++j) {
    const Subject::Track& track = *plan_->track[j];
    const Branches branches = at(j, time, rest);
    if (branches.detected > 0) {
      detected += branches.detected;
      detected_sum += branches.detected * gaussian_entropy(branches.covariance.pp, dims);
    }
    Covariance free = blocks_of(track.state);
    free.predict(track.psd, track.moves, time, dims);
    const double h = gaussian_entropy(free.pp, dims);
    add_undetected(branches.undetected, h);
    const double mass = track.leak > 0 ? track.weight * std::exp(-track.leak * time) : track.weight;
    lost += track.weight - mass;
    without += mass * (h - plan_->log_weight[j] + track.leak * time);
  }
  for (int k = plan_->first_tile[i]; k < plan_->first_tile[i + 1]; ++k) {
    const Subject::Tile& tile = *plan_->tile[k];
    const double h = std::log(tile.volume);
    add_undetected(tiles_[k], h);
    without += tile.weight * h - plogp(tile.weight);
  }
  add_undetected(rest.lost_undetected, subject.lost_entropy);
  if (lost > 0) without += lost * subject.lost_entropy - plogp(lost);
  if (rest.found > 0) {
    Covariance found = rest.covariance;
    found.predict(subject.found_psd, subject.found_moves, time - rest.time, dims);
    detected += rest.found;
    detected_sum += rest.found * gaussian_entropy(found.pp, dims);
  }
  if (rest.lost_detected > 0) {
    const double seen = detected;
    detected += rest.lost_detected;
    detected_sum +=
        rest.lost_detected * subject.lost_entropy + detected * binary_entropy(seen / detected);
  }
  const double other = subject.class_entropy + subject.attribute_entropy;
  double with = subject.p * (detected_sum + detected * other - rest.class_gain);
  const double missed = 1 - subject.p * detected;
  if (missed > 0 && undetected > 0) {
    const double p = std::min(1.0, subject.p * undetected / missed);
    const double position = undetected_sum / undetected + std::log(undetected);
    with += missed * (binary_entropy(p) + p * (position + other));
  }
  return {plan_->existence_entropy[i] + subject.p * (without + other), with};
}

double Forecast::gain_of(int subject, double time) const {
  if (!is_seen_[subject]) return 0;
  const Entropies h = entropies(subject, time);
  return h.without - h.with;
}

double Forecast::gain(double time) const {
  double sum = 0;
  for (const int subject : seen_) sum += gain_of(subject, time);
  return sum;
}

double expected_gain(const std::vector<Subject>& subjects, const std::vector<Glance>& looks,
                     double end, const Site& site) {
  Forecast forecast(subjects, site);
  for (const Glance& look : looks) forecast.look(look);
  return forecast.gain(end);
}

}  // namespace anchord
