#include "tools/anchor_tune/motion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/log_probability.h"
#include "models/kinematic.h"
#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {
namespace {

using Kind = BehaviourModel::Kind;

constexpr int kRounds = 4;        // the strays hardly change after the first
constexpr double kStrays = 1e-4;  // share of gross errors at least, however wide the gate

int count_gaps(const std::vector<MeasuredTrack>& tracks) {
  std::vector<double> steps;
  for (const MeasuredTrack& track : tracks)
    for (std::size_t i = 1; i < track.seconds.size(); ++i)
      steps.push_back(track.seconds[i] - track.seconds[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  // Stamps jitter: what is no whole step more is no gap.
  const double median = *middle;
  return static_cast<int>(
      std::count_if(steps.begin(), steps.end(), [&](double s) { return s > 1.5 * median; }));
}

}  // namespace

std::vector<MeasuredTrack> tracks_of(const Judgement& judgement, int object_class) {
  std::map<std::pair<int, std::string>, std::pair<Utime, MeasuredTrack>> tracks;
  for (const JudgedFrame& frame : judgement.frames)
    for (const Judged& z : frame.detections) {
      if (z.verdict != Verdict::kRight || z.object_class != object_class) continue;
      auto& [first, track] =
          tracks.try_emplace({frame.recording, z.object}, frame.utime, MeasuredTrack{})
              .first->second;
      track.seconds.push_back(seconds_between(first, frame.utime));
      track.positions.push_back(z.placed.position);
    }
  std::vector<MeasuredTrack> out;
  for (auto& [key, track] : tracks)
    if (track.second.seconds.size() > 1) out.push_back(std::move(track.second));
  return out;
}

Innovations innovations(const std::vector<MeasuredTrack>& tracks, const Strays& left_out,
                        const BehaviourModel& model, double gate_probability, double radius,
                        int dims) {
  const double ball = dims == 2 ? std::numbers::pi * radius * radius
                                : 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  const double stray = std::max(1 - gate_probability, kStrays);
  const double log_right = std::log1p(-stray), log_stray = std::log(stray / ball);
  Innovations out;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const MeasuredTrack& track = tracks[t];
    auto& strays = out.strays.emplace_back(track.positions.size(), 0);
    Kinematic state = kinematic_at(track.positions[0], model.initial_velocity_variance, dims);
    for (std::size_t i = 1; i < track.positions.size(); ++i) {
      const double dt = track.seconds[i] - track.seconds[i - 1];
      if (model.kind == Kind::kConstantVelocity)
        predict_constant_velocity(state, model.psd, dt, dims);
      else
        predict_constant_position(state, model.psd, dt, dims);
      const double right = log_right + fit(state, track.positions[i], dims).log_likelihood;
      out.log_likelihood += log_add(right, log_stray);
      strays[i] = right < log_stray;
      if (left_out.empty() || !left_out[t][i]) update(state, track.positions[i], dims);
    }
  }
  return out;
}

BehaviourModel Motion::applied_to(BehaviourModel model) const {
  const double height = vertical ? vertical->value : model.psd.vertical();
  model.psd = {psd.value, height * psd.value};
  const double speed = initial_velocity_variance.value;
  if (model.kind == Kind::kConstantVelocity)
    model.initial_velocity_variance = {speed, height * speed};
  return model;
}

std::optional<Motion> fit_motion(const std::vector<MeasuredTrack>& tracks,
                                 const BehaviourModel& model, double gate_probability,
                                 double radius, int dims) {
  if (tracks.empty()) return std::nullopt;
  const bool velocity = model.kind == Kind::kConstantVelocity;
  Strays strays;
  const bool height = dims == 3;
  const auto at = [&](const std::vector<double>& x) {
    BehaviourModel tried = model;
    const double vertical = height ? std::exp(x.back()) : model.psd.vertical();
    tried.psd = {std::exp(x[0]), vertical * std::exp(x[0])};
    if (velocity) tried.initial_velocity_variance = {std::exp(x[1]), vertical * std::exp(x[1])};
    return innovations(tracks, strays, tried, gate_probability, radius, dims);
  };
  const auto f = [&](const std::vector<double>& x) { return at(x).log_likelihood; };
  std::vector<double> start{std::log(std::max(model.psd.plane, 1e-9))};
  if (velocity) start.push_back(std::log(std::max(model.initial_velocity_variance.plane, 1e-9)));
  if (height) start.push_back(std::log(std::clamp(model.psd.vertical(), 1e-3, 1.0)));
  Optimum best = maximise(f, start, 1, 400);
  for (int round = 0; round < kRounds; ++round) {
    Strays found = at(best.at).strays;
    if (found == strays) break;
    strays = std::move(found);
    best = maximise(f, best.at, 0.3, 200);
  }
  Motion motion;
  motion.psd = profile_interval(f, best, 0, Scale::kLog);
  if (velocity) motion.initial_velocity_variance = profile_interval(f, best, 1, Scale::kLog);
  if (height) motion.vertical = profile_interval(f, best, start.size() - 1, Scale::kLog);
  motion.tracks = static_cast<int>(tracks.size());
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    motion.detections += static_cast<int>(tracks[t].positions.size());
    if (!strays.empty())
      motion.strays += static_cast<int>(std::count(strays[t].begin(), strays[t].end(), 1));
  }
  motion.gaps = count_gaps(tracks);
  return motion;
}

}  // namespace anchord::tuning
