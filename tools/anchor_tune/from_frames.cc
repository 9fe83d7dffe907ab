#include "tools/anchor_tune/from_frames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "anchoring/world.h"
#include "tools/anchor_tune/knowledge_parts.h"

namespace anchord::tuning {
namespace {

using nlohmann::json;

/// Clutter that was expected of scored detections but is not, or the other way round: what
/// log_evidence() puts right.
double expected_amiss(const Recording& recording, const Background& background) {
  struct Sums {
    double right = 0, wrong = 0, volume = 0;
    bool scored = false;
  };
  std::map<std::string, Sums> sums;
  std::unique_ptr<Visibility> visibility;
  for (const Frame& frame : recording.frames) {
    const auto placed = place_in_map(frame, background);
    if (!visibility || !visibility->same_for(*placed))
      visibility = std::make_unique<Visibility>(*placed, background);
    Sums& sum = sums[frame.sensor];
    sum.volume += visibility->volume();
    for (std::size_t z = 0; z < frame.detections.size(); ++z) {
      sum.scored = sum.scored || frame.detections[z].score;
      const double against = std::exp(-placed->detections[z].log_odds.value_or(0));
      sum.right += 1 / (1 + against);
      sum.wrong += against / (1 + against);
    }
  }
  double amiss = 0;
  for (const auto& [name, sum] : sums)
    if (sum.scored)
      amiss += background.knowledge.sensor(name).clutter_density * sum.volume *
               (1 - sum.wrong / sum.right);
  return amiss;
}

void add_class(const Knowledge& knowledge, std::size_t c, std::vector<Parameter>& out) {
  const ObjectClass& k = knowledge.classes[c];
  const JsonPath at = JsonPath("/classes") / k.name;
  const auto add = [&](const char* key, double ObjectClass::*member) {
    if (k.*member > 0)
      out.push_back({at / key, Scale::kLog, k.*member,
                     [=](Knowledge& to, double value) { to.classes[c].*member = value; }});
  };
  add("arrival_rate", &ObjectClass::arrival_rate);
  add("departure_rate", &ObjectClass::departure_rate);
  add("undetected_intensity", &ObjectClass::undetected_intensity);
  for (std::size_t t = 0; t < k.transitions.size(); ++t)
    if (k.transitions[t].rate > 0)
      out.push_back({at / "transitions" / t / "rate", Scale::kLog, k.transitions[t].rate,
                     [=](Knowledge& to, double v) { to.classes[c].transitions[t].rate = v; }});
  const auto first = std::find_if(k.models.begin(), k.models.end(),
                                  [](const BehaviourModel& m) { return m.tracked(); });
  const bool one_kind = std::all_of(k.models.begin(), k.models.end(), [&](const auto& m) {
    return !m.tracked() || m.kind == first->kind;
  });
  if (!one_kind) return;
  const JsonPath model = at / "models" / static_cast<std::size_t>(first - k.models.begin());
  const bool velocity = first->kind == BehaviourModel::Kind::kConstantVelocity;
  const auto move = [&](const char* key, ByAxis BehaviourModel::*member) {
    const auto set = [=](Knowledge& to, double value) {
      for (BehaviourModel& m : to.classes[c].models)
        if (m.tracked()) m.*member = (m.*member).with_plane(value);
    };
    const double now = ((*first).*member).plane;
    if (now > 0) out.push_back({model / key, Scale::kLog, now, set});
  };
  move(velocity ? "acceleration_psd" : "position_psd", &BehaviourModel::psd);
  if (velocity) move("initial_velocity_variance", &BehaviourModel::initial_velocity_variance);
}

/// As it is; or by what it looks like.
void add_clutter(const Knowledge& knowledge, const Sensor& sensor, const JsonPath& at,
                 std::vector<Parameter>& out) {
  const std::string name = sensor.name;
  if (sensor.clutter_looks.empty())
    out.push_back({at, Scale::kLog, sensor.clutter_density, [=](Knowledge& to, double value) {
                     own_settings(to, name).clutter_density = value;
                   }});
  for (std::size_t c = 0; c < sensor.clutter_looks.size(); ++c) {
    if (!(sensor.clutter_looks[c] > 0)) continue;
    out.push_back({at / knowledge.classes[c].name, Scale::kLog,
                   sensor.clutter_density * sensor.clutter_looks[c],
                   [=](Knowledge& to, double value) {
                     Sensor& s = own_settings(to, name);
                     const double sum = s.clutter_density * (1 - s.clutter_looks[c]) + value;
                     for (double& share : s.clutter_looks) share *= s.clutter_density / sum;
                     s.clutter_looks[c] = value / sum;
                     s.clutter_density = sum;
                   }});
  }
}

/// What must stand before single numbers of it can be told.
Findings whole_parts(const Knowledge& knowledge) {
  Findings out;
  for (const ObjectClass& c : knowledge.classes) {
    const JsonPath at = JsonPath("/classes") / c.name;
    out.push_back({at / "models", models_json(c.models, knowledge), ""});
    json transitions = json::array();
    for (const Transition& t : c.transitions)
      transitions.push_back({{"from", t.from}, {"to", t.to}, {"rate", number(t.rate)}});
    out.push_back({at / "transitions", transitions, ""});
  }
  for (const Sensor& sensor : knowledge.sensors)
    for (std::size_t c = 0; c < knowledge.classes.size(); ++c)
      if (const auto& [near, per_m] = sensor.detection_probability[c]; per_m != 0)
        out.push_back({JsonPath("/sensors") / sensor.name / "detection_probability" /
                           knowledge.classes[c].name,
                       {number(near), number(per_m)},
                       ""});
  return out;
}

}  // namespace

std::vector<Parameter> parameters_of(Knowledge& knowledge,
                                     const std::vector<std::string>& sensors) {
  std::vector<Parameter> out;
  for (const std::string& name : sensors) own_settings(knowledge, name);
  for (const std::string& name : sensors) {
    const Sensor& sensor = own_settings(knowledge, name);
    const JsonPath at = JsonPath("/sensors") / name;
    add_clutter(knowledge, sensor, at / "clutter_density", out);
    for (std::size_t c = 0; c < knowledge.classes.size(); ++c) {
      const DetectionProbability& p = sensor.detection_probability[c];
      if (!(p.near > 0)) continue;
      const JsonPath place = at / "detection_probability" / knowledge.classes[c].name;
      const bool ranged = p.per_m != 0;
      out.push_back({ranged ? place / std::size_t{0} : place, Scale::kLogit, p.near,
                     [=](Knowledge& to, double value) {
                       own_settings(to, name).detection_probability[c].near = value;
                     }});
      if (!ranged) continue;
      out.push_back(
          {place / std::size_t{1}, Scale::kPerMetre, p.per_m, [=](Knowledge& to, double value) {
             own_settings(to, name).detection_probability[c].per_m = value;
           }});
    }
  }
  for (std::size_t c = 0; c < knowledge.classes.size(); ++c) add_class(knowledge, c, out);
  return out;
}

Result<double> log_evidence(const Knowledge& knowledge, const std::vector<Recording>& recordings) {
  double sum = 0;
  for (const Recording& recording : recordings) {
    World world(knowledge);
    for (const Frame& frame : recording.frames)
      if (const Status done = world.apply(frame); !done) return done.error();
    sum += world.belief()->log_evidence + expected_amiss(recording, *world.background());
  }
  return sum;
}

Result<Findings> findings_from_frames(const std::vector<Recording>& recordings, Knowledge knowledge,
                                      int evaluations) {
  std::set<std::string> names;
  std::size_t frames = 0;
  for (const Recording& recording : recordings) {
    frames += recording.frames.size();
    for (const Frame& frame : recording.frames) names.insert(frame.sensor);
  }
  const auto parameters = parameters_of(knowledge, {names.begin(), names.end()});
  const auto before = log_evidence(knowledge, recordings);
  if (!before) return before.error();
  const auto f = [&](const std::vector<double>& x) {
    Knowledge tried = knowledge;
    for (std::size_t i = 0; i < x.size(); ++i) {
      // Far out on the scale a probability would be rounded to 1.
      const double free = std::clamp(x[i], -30.0, parameters[i].scale == Scale::kLog ? 30.0 : 15.0);
      parameters[i].set(tried, from_free(free, parameters[i].scale));
    }
    return log_evidence(tried, recordings).value();
  };
  std::vector<double> start;
  std::vector<Scale> scales;
  for (const Parameter& p : parameters) {
    start.push_back(to_free(p.start, p.scale));
    scales.push_back(p.scale);
  }
  Optimum best = maximise(f, start, 0.7, evaluations);
  const auto estimates = curvature_intervals(f, best, scales);
  Findings all = whole_parts(knowledge);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    all.push_back(estimated(parameters[i].path, estimates[i],
                            "Maximum likelihood of the frames alone",
                            " It was " + rounded(parameters[i].start) + "."));
  all.push_back({JsonPath(), nullptr,
                 "the log-evidence of " + std::to_string(frames) + " frames rose from " +
                     std::to_string(*before) + " to " + std::to_string(best.value) + " in " +
                     std::to_string(best.evaluations) + " evaluations"});
  return all;
}

}  // namespace anchord::tuning
