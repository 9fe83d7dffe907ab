#include <algorithm>
#include <map>

#include "tools/anchor_tune/births.h"
#include "tools/anchor_tune/chain.h"
#include "tools/anchor_tune/from_truth.h"
#include "tools/anchor_tune/knowledge_parts.h"
#include "tools/anchor_tune/motion.h"

namespace anchord::tuning {
namespace {

using nlohmann::json;

Glances glances_of(const Judgement& judgement, int object_class) {
  std::map<std::pair<int, std::string>, std::pair<Utime, std::vector<Glance>>> objects;
  for (const JudgedFrame& frame : judgement.frames)
    for (const Sight& sight : frame.sights) {
      if (sight.object_class != object_class) continue;
      auto& [last, looks] =
          objects.try_emplace({frame.recording, sight.object}, frame.utime, std::vector<Glance>())
              .first->second;
      looks.push_back({seconds_between(last, frame.utime), frame.sensor, sight.found, sight.range});
      last = frame.utime;
    }
  Glances glances;
  for (auto& [key, object] : objects) glances.push_back(std::move(object.second));
  return glances;
}

std::string looks_text(const Glances& glances) {
  std::size_t looks = 0;
  for (const auto& object : glances) looks += object.size();
  return std::to_string(looks) + " looks at " + std::to_string(glances.size()) + " objects";
}

void add_models(const Judgement& judgement, int object_class, const Knowledge& knowledge,
                const TruthOptions& options, const Detectability& seen, const Glances& glances,
                Findings& out) {
  const ObjectClass& c = knowledge.classes[static_cast<std::size_t>(object_class)];
  const JsonPath at = JsonPath("/classes") / c.name;
  const int only = single_model(c);
  if (only < 0) {
    out.push_back({JsonPath(), nullptr,
                   dotted(at) + ": has several tracked models: they are as they "
                                "were, and it is not told when it hides"});
    return;
  }
  BehaviourModel moving = c.models[static_cast<std::size_t>(only)];
  moving.initial_weight = 1;
  const auto motion = fit_motion(tracks_of(judgement, object_class), moving,
                                 knowledge.limits.gate_probability, options.radius, knowledge.dims);
  add_motion(c, moving, motion, seen.hidden, knowledge, out);
  if (!motion)
    out.push_back(
        {JsonPath(), nullptr, dotted(at) + ": no object was found twice; its motion is as it was"});
  if (!seen.hidden) {
    out.push_back({at / "transitions", json::array(),
                   "Misses do not come together: a hidden state gains " +
                       rounded(std::max(0.0, seen.gain)) +
                       " in log-likelihood, less than its two rates cost."});
    return;
  }
  out.push_back({at / "models" / std::size_t{1} / "detectable", false,
                 "Misses come together: a hidden state of the same motion gains " +
                     rounded(seen.gain) + " in log-likelihood over " + looks_text(glances) + "."});
  out.push_back({at / "transitions",
                 {{{"from", 0}, {"to", 1}}, {{"from", 1}, {"to", 0}}},
                 "A hidden Markov model of found and missed."});
  const JsonPath transitions = at / "transitions";
  out.push_back(estimated(transitions / std::size_t{0} / "rate", seen.hide, "It hides, per s"));
  out.push_back(
      estimated(transitions / std::size_t{1} / "rate", seen.show, "It shows itself, per s"));
}

/// One sensor's p_D, and where it changes with the distance by how much.
void add_detection_probability(const JsonPath& at, const Estimate& p,
                               const std::optional<Estimate>& per_m, const std::string& how,
                               Findings& out) {
  if (!per_m) {
    out.push_back(estimated(at, p, how));
    return;
  }
  out.push_back({at, {number(p.value), number(per_m->value)}, ""});
  out.push_back(estimated(at / std::size_t{0}, p, how + ", near at hand"));
  out.push_back(estimated(at / std::size_t{1}, *per_m, "By which its logit changes, per m"));
}

void add_detection(const Judgement& judgement, int object_class, const Knowledge& knowledge,
                   const Detectability& seen, const Glances& glances, Findings& out) {
  const std::string& name = knowledge.classes[static_cast<std::size_t>(object_class)].name;
  std::vector<int> looks(judgement.sensors.size(), 0);
  for (const auto& object : glances)
    for (const Glance& look : object) ++looks[static_cast<std::size_t>(look.sensor)];
  const auto most = std::max_element(looks.begin(), looks.end()) - looks.begin();
  for (std::size_t s = 0; s < judgement.sensors.size(); ++s) {
    if (looks[s] == 0) continue;
    Estimate p = seen.detection_probability[s];
    // Never certain: as if one half more had been missed.
    p.value = std::min(p.value, (looks[s] + 0.5) / (looks[s] + 1));
    const std::string how = std::to_string(looks[s]) + " looks of " + judgement.sensors[s] +
                            (seen.hidden ? ", while it is not hidden" : "") +
                            (seen.per_m ? "; that it changes with the distance gains " +
                                              rounded(seen.range_gain) + " in log-likelihood"
                                        : "");
    if (static_cast<std::ptrdiff_t>(s) == most && seen.range_pays && !seen.per_m)
      out.push_back({JsonPath(), nullptr,
                     "classes." + name +
                         ".detection_probability: that it changes with the distance would gain " +
                         rounded(seen.range_gain) +
                         " in log-likelihood; it may where the base has [p, c]"});
    if (static_cast<std::ptrdiff_t>(s) == most)
      add_detection_probability(JsonPath("/classes") / name / "detection_probability", p,
                                seen.per_m, how, out);
    const auto& now = knowledge.sensor(judgement.sensors[s]).detection_probability;
    const bool own =
        now[static_cast<std::size_t>(object_class)] !=
        knowledge.classes[static_cast<std::size_t>(object_class)].detection_probability;
    if (own || judgement.sensors.size() > 1)
      add_detection_probability(
          JsonPath("/sensors") / judgement.sensors[s] / "detection_probability" / name, p,
          seen.per_m, how, out);
  }
}

void add_turnover(const Judgement& judgement, int object_class, const Knowledge& knowledge,
                  const TruthOptions& options, Findings& out) {
  const JsonPath at =
      JsonPath("/classes") / knowledge.classes[static_cast<std::size_t>(object_class)].name;
  const std::string unit = knowledge.dims == 2 ? "m^2" : "m^3";
  const Turnover t = turnover_of(judgement, object_class);
  const auto rate = [](std::int64_t count, double exposure) {
    Estimate e = poisson_rate(count, exposure);
    if (count == 0) e.value = 0.5 / exposure;  // none yet is not never
    return e;
  };
  if (t.new_volume > 0) {
    out.push_back(estimated(at / "undetected_intensity", rate(t.there, t.new_volume),
                            "Per " + unit + ": " + std::to_string(t.there) +
                                " objects were met on " + rounded(t.new_volume) + " " + unit +
                                " that came into view for the first time"));
  }
  if (t.object_seconds > 0) {
    out.push_back(estimated(at / "departure_rate", rate(t.ends, t.object_seconds),
                            "Per s: " + std::to_string(t.ends) +
                                " objects were gone before their recording ended, after " +
                                rounded(t.object_seconds) + " s of being there altogether",
                            " Whoever leaves the view for good is among them."));
  }
  if (!(t.exposure > 0)) {
    out.push_back({JsonPath(), nullptr,
                   dotted(at) + ": nowhere was looked twice; arrivals are as they were"});
    return;
  }
  std::vector<Gate> gates;
  if (options.gates > 0 && !t.arrivals.empty())
    gates = fit_gates(t.arrivals, t.exposure / t.seconds, options.gates, knowledge.cell,
                      knowledge.dims);
  double elsewhere = static_cast<double>(t.arrivals.size());
  json places = json::array();
  for (const Gate& gate : gates) {
    const double count = gate.share * static_cast<double>(t.arrivals.size());
    elsewhere -= count;
    json mean = json::array(), covariance = json::array();
    for (int i = 0; i < knowledge.dims; ++i) {
      mean.push_back(number(gate.mean[i]));
      for (int j = 0; j < knowledge.dims; ++j) covariance.push_back(number(gate.covariance(i, j)));
    }
    places.push_back(
        {{"mean", mean}, {"covariance", covariance}, {"rate", number(count / t.seconds)}});
  }
  const std::string came = std::to_string(t.arrivals.size()) + " objects came in " +
                           rounded(t.seconds) + " s where it had been looked before";
  const auto rest = static_cast<int>(std::max(0.0, elsewhere) + 0.5);
  out.push_back({at / "arrivals", places,
                 gates.empty() ? ""
                               : "Where objects come in: " + came + ", " +
                                     std::to_string(static_cast<int>(t.arrivals.size()) - rest) +
                                     " of them at one of these."});
  out.push_back(
      estimated(at / "arrival_rate", rate(rest, t.exposure),
                "Per " + unit + " and s: " + came +
                    (gates.empty() ? "" : ", " + std::to_string(rest) + " of them elsewhere")));
}

}  // namespace

Findings class_findings(const Judgement& judgement, int object_class, const Knowledge& knowledge,
                        const TruthOptions& options) {
  Findings out;
  const Glances glances = glances_of(judgement, object_class);
  if (glances.empty()) {
    out.push_back({JsonPath(), nullptr,
                   "classes." + knowledge.classes[static_cast<std::size_t>(object_class)].name +
                       ": no truth of it was in view; it is as it was"});
    return out;
  }
  const auto c = static_cast<std::size_t>(object_class);
  const bool ranged =
      knowledge.classes[c].detection_probability.per_m != 0 ||
      std::any_of(judgement.sensors.begin(), judgement.sensors.end(), [&](const std::string& name) {
        return knowledge.sensor(name).detection_probability[c].per_m != 0;
      });
  const Detectability seen =
      fit_detectability(glances, static_cast<int>(judgement.sensors.size()), ranged);
  add_models(judgement, object_class, knowledge, options, seen, glances, out);
  add_detection(judgement, object_class, knowledge, seen, glances, out);
  add_turnover(judgement, object_class, knowledge, options, out);
  return out;
}

}  // namespace anchord::tuning
