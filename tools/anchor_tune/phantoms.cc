#include "tools/anchor_tune/phantoms.h"

#include <algorithm>
#include <cmath>

#include "mht/assignment.h"
#include "models/kinematic.h"
#include "tools/anchor_tune/knowledge_parts.h"

namespace anchord::tuning {
namespace {

constexpr int kRounds = 2;  // of linking and fitting

/// Links the false detections of one recording.
class Linker {
 public:
  Linker(const Wanted& wanted, const BehaviourModel& model, double gate_distance2, double radius,
         int dims)
      : wanted_(wanted),
        model_(model),
        gate_distance2_(gate_distance2),
        radius_(radius),
        dims_(dims) {}

  void take(const JudgedFrame& frame) {
    std::vector<const Judged*> wrong;
    for (const Judged& z : frame.detections)
      if (z.verdict == Verdict::kFalse && wanted_(z)) wrong.push_back(&z);
    for (Open& open : open_) predict(open, frame.utime);
    std::vector<char> found(open_.size(), 0);
    const std::vector<int> chains = links(wrong);
    for (std::size_t i = 0; i < wrong.size(); ++i) {
      if (chains[i] < 0) continue;
      const auto k = static_cast<std::size_t>(chains[i]);
      found[k] = 1;
      go_on(open_[k], *wrong[i], frame);
    }
    for (std::size_t k = 0; k < found.size(); ++k)
      if (!found[k] && frame.view.contains(open_[k].state.position)) look(open_[k], frame, false);
    for (std::size_t i = 0; i < wrong.size(); ++i)
      if (chains[i] < 0) begin(*wrong[i], frame);
    // Not looked at: it is out of view.
    std::erase_if(open_, [&](Open& open) {
      if (open.missed < kPatience && open.look_utime == frame.utime) return false;
      done_.push_back(std::move(open.chain));
      return true;
    });
  }

  std::vector<FalseChain> finish() {
    for (Open& open : open_) done_.push_back(std::move(open.chain));
    return std::move(done_);
  }

 private:
  struct Open {
    FalseChain chain;
    Kinematic state;
    Utime first = 0, state_utime = 0, look_utime = 0;
    int missed = 0;
  };

  void predict(Open& open, Utime utime) const {
    const double dt = seconds_between(open.state_utime, utime);
    if (model_.kind == BehaviourModel::Kind::kConstantVelocity)
      predict_constant_velocity(open.state, model_.psd, dt, dims_);
    else
      predict_constant_position(open.state, model_.psd, dt, dims_);
    open.state_utime = utime;
  }

  /// The open chain of each detection, or -1.
  std::vector<int> links(const std::vector<const Judged*>& wrong) const {
    const Scratch scratch;
    PairGains gains(static_cast<int>(wrong.size()), static_cast<int>(open_.size()));
    for (const Judged* z : wrong) {
      gains.start_row();
      for (std::size_t k = 0; k < open_.size(); ++k) {
        const Gaussian& at = z->placed.position;
        if ((at.mean - open_[k].state.position).head(dims_).norm() > radius_) continue;
        const double distance2 = fit(open_[k].state, at, dims_).distance2;
        if (distance2 < gate_distance2_)
          gains.add(static_cast<int>(k), gate_distance2_ - distance2);
      }
    }
    const Assignment assignment(gains);
    std::vector<int> out;
    for (int z = 0; z < assignment.detections(); ++z)
      out.push_back(assignment.choice(z) == Assignment::kNone ? -1 : assignment.choice(z));
    return out;
  }

  void begin(const Judged& z, const JudgedFrame& frame) {
    Open& open = open_.emplace_back();
    open.state = kinematic_at(z.placed.position, model_.initial_velocity_variance, dims_);
    open.first = open.state_utime = open.look_utime = frame.utime;
    open.chain.sensor = frame.sensor;
    open.chain.seen_before = z.seen_before;
    add(open, z, frame);
  }

  void go_on(Open& open, const Judged& z, const JudgedFrame& frame) {
    update(open.state, z.placed.position, dims_);
    look(open, frame, true);
    add(open, z, frame);
  }

  static void look(Open& open, const JudgedFrame& frame, bool found) {
    open.chain.looks.push_back(
        {seconds_between(open.look_utime, frame.utime), frame.sensor, found});
    open.look_utime = frame.utime;
    open.missed = found ? 0 : open.missed + 1;
  }

  static void add(Open& open, const Judged& z, const JudgedFrame& frame) {
    open.chain.track.seconds.push_back(seconds_between(open.first, frame.utime));
    open.chain.track.positions.push_back(z.placed.position);
    if (!z.score) return;
    open.chain.log_odds.push_back(log_odds(*z.score));
    open.chain.ranges.push_back(z.placed.range);
  }

  const Wanted& wanted_;
  const BehaviourModel& model_;
  double gate_distance2_, radius_;
  int dims_;
  std::vector<Open> open_;
  std::vector<FalseChain> done_;
};

}  // namespace

std::vector<FalseChain> link_false(const Judgement& judgement, const Wanted& wanted,
                                   const BehaviourModel& model, double gate_distance2,
                                   double radius, int dims) {
  std::vector<FalseChain> out;
  std::optional<Linker> linker;
  int recording = -1;
  const auto finish = [&] {
    if (!linker) return;
    for (FalseChain& chain : linker->finish()) out.push_back(std::move(chain));
  };
  for (const JudgedFrame& frame : judgement.frames) {
    if (frame.recording != recording) {
      finish();
      linker.emplace(wanted, model, gate_distance2, radius, dims);
      recording = frame.recording;
    }
    linker->take(frame);
  }
  finish();
  return out;
}

std::optional<Phantoms> find_phantoms(const Judgement& judgement, const Wanted& wanted, int look,
                                      const std::vector<int>& classes, const Knowledge& knowledge,
                                      double radius) {
  const int dims = knowledge.dims;
  const double gate = knowledge.limits.gate_probability;
  const double gate_distance2 = Background(knowledge).gate_distance2;
  const auto model_of = [&](int c) {
    const ObjectClass& phantom = knowledge.classes[static_cast<std::size_t>(c)];
    return phantom.models[static_cast<std::size_t>(single_model(phantom))];
  };
  BehaviourModel model = model_of(classes[0]);
  Phantoms out;
  out.look = look;
  for (int round = 0; round < kRounds; ++round) {
    out.chains = link_false(judgement, wanted, model, gate_distance2, radius, dims);
    std::vector<MeasuredTrack> tracks;
    for (const FalseChain& chain : out.chains)
      if (chain.track.seconds.size() > 1) tracks.push_back(chain.track);
    const auto motion = fit_motion(tracks, model, gate, radius, dims);
    if (!motion) return std::nullopt;
    model = motion->applied_to(model);
  }
  std::vector<Looks> looks;
  for (const FalseChain& chain : out.chains) looks.push_back(chain.looks);
  const auto all = fit_fleeting(looks, static_cast<int>(classes.size()));
  if (!all) return std::nullopt;
  out.gain = all->gain;
  out.clutter.assign(judgement.sensors.size(), 0);
  for (const Fleeting& fleeting : all->kinds) out.kinds.push_back({fleeting, {}, 0, 0});
  std::vector<std::vector<MeasuredTrack>> tracks(classes.size());
  for (const FalseChain& chain : out.chains) {
    const auto shares = all->shares(chain.looks);
    double clutter = 1;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      clutter -= shares[k];
      (chain.seen_before ? out.kinds[k].arrived : out.kinds[k].there) += shares[k];
    }
    out.clutter[static_cast<std::size_t>(chain.sensor)] += clutter;
    const auto top = std::max_element(shares.begin(), shares.end()) - shares.begin();
    if (chain.track.seconds.size() > 1)
      tracks[static_cast<std::size_t>(top)].push_back(chain.track);
  }
  const auto alike = look < 0 ? std::vector<MeasuredTrack>{} : tracks_of(judgement, look);
  for (std::size_t k = 0; k < classes.size(); ++k)
    out.kinds[k].motion =
        fit_motion(alike.empty() ? tracks[k] : alike, model_of(classes[k]), gate, radius, dims);
  return out;
}

}  // namespace anchord::tuning
