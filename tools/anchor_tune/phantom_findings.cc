#include <cmath>

#include "tools/anchor_tune/births.h"
#include "tools/anchor_tune/from_truth.h"
#include "tools/anchor_tune/knowledge_parts.h"

namespace anchord::tuning {
namespace {

using nlohmann::json;

/// A count that is expected, not counted, per exposure.
Estimate expected_rate(double count, double exposure) {
  Estimate e = poisson_rate(std::llround(count), exposure);
  e.value = std::max(count, 0.5) / exposure;  // none yet is not never
  return e;
}

Estimate times(Estimate e, double factor) {
  return {factor * e.value, factor * e.low, factor * e.high};
}

/// Of phantoms that arrive at one rate, leave at another, and are looked at every `seconds`, as
/// many are found for the first time as this per arrival: what nobody has seen is then in balance,
/// lambda = lambda (1 - p) exp(-mu dt) + beta (1 - exp(-mu dt)) / mu.
double found_per_arrival(double p, double departure, double seconds) {
  const double stays = std::exp(-departure * seconds);
  return p * (1 - stays) / (departure * seconds) / (1 - (1 - p) * stays);
}

}  // namespace

Findings phantom_findings(const Judgement& judgement, int object_class, const Phantoms& phantoms,
                          std::size_t number, const Knowledge& knowledge) {
  const ObjectClass& c = knowledge.classes[static_cast<std::size_t>(object_class)];
  const JsonPath at = JsonPath("/classes") / c.name;
  const PhantomKind& kind = phantoms.kinds[number];
  const Fleeting& f = kind.fleeting;
  const double found = f.detection_probability.value, departure = f.departure.value;
  Findings out;
  add_motion(c, c.models[static_cast<std::size_t>(single_model(c))], kind.motion, f.hidden,
             knowledge, out);
  const std::string gain = rounded(std::max(0.0, phantoms.gain)) + " in log-likelihood";
  if (f.hidden) {
    const JsonPath transitions = at / "transitions";
    out.push_back({transitions,
                   {{{"from", 0}, {"to", 1}}, {{"from", 1}, {"to", 0}}},
                   "Misses come together: hidden states of all phantoms gain " + gain + "."});
    out.push_back(estimated(transitions / std::size_t{0} / "rate", f.hide, "It hides, per s"));
    out.push_back(
        estimated(transitions / std::size_t{1} / "rate", f.show, "It shows itself, per s"));
  } else {
    out.push_back(
        {at / "transitions", json::array(),
         "Misses do not come together: hidden states of all phantoms gain " + gain + "."});
  }
  std::size_t again = 0, detections = 0;
  double looks = 0, seconds = 0;
  for (const FalseChain& chain : phantoms.chains) {
    again += chain.track.seconds.size() > 1;
    detections += chain.track.seconds.size();
    for (const Glance& look : chain.looks) ++looks, seconds += look.seconds;
  }
  out.push_back(estimated(
      at / "detection_probability", f.detection_probability,
      std::to_string(detections) + " false detections" +
          (phantoms.look < 0 ? "" : " labelled " + knowledge.classes[phantoms.look].name) +
          ", linked to " + std::to_string(phantoms.chains.size()) + " chains, " +
          std::to_string(again) +
          " of more than one: a hidden Markov model of found, missed and gone, this kind (" +
          f.share.text() + " of the chains) beside " +
          (phantoms.kinds.size() > 1 ? "the other and " : "") + "clutter"));
  out.push_back(estimated(at / "departure_rate", f.departure, "From the same, per s"));
  const std::string unit = knowledge.dims == 2 ? "m^2" : "m^3";
  const Turnover looked = turnover_of(judgement, object_class);
  if (looked.new_volume > 0)
    out.push_back(estimated(
        at / "undetected_intensity", times(expected_rate(kind.there, looked.new_volume), 1 / found),
        "Per " + unit + ": " + rounded(kind.there) + " chains are expected to be of this kind on " +
            rounded(looked.new_volume) + " " + unit + " that came into view for the first time"));
  if (looked.exposure > 0)
    out.push_back(estimated(
        at / "arrival_rate",
        times(expected_rate(kind.arrived, looked.exposure),
              1 / found_per_arrival(found, departure, seconds / looks)),
        "Per " + unit + " and s: " + rounded(kind.arrived) +
            " chains are expected to be of this kind where it had been looked before; those that "
            "left before they were detected added"));
  out.push_back({at / "arrivals", json::array(), ""});
  return out;
}

}  // namespace anchord::tuning
