#include "api/answers.h"

#include <algorithm>

namespace anchord {
namespace {

constexpr double kLeastShown = 0.001;

/// Where an object may be: each place with its mass, most first, and the mass outside of all.
Json places_json(const ObjectBelief& object, const Background& background) {
  const auto& places = background.knowledge.places;
  std::vector<std::pair<double, int>> mass;
  double outside = 1;  // of the outermost ones, where they are disjoint
  for (int i = 0; i < static_cast<int>(places.size()); ++i) {
    const double p = object.in_place(i, background);
    if (places[i].parent < 0) outside -= p;
    if (p >= kLeastShown) mass.emplace_back(p, i);
  }
  if (!background.places_nest()) outside = object.outside_places(background);
  std::stable_sort(mass.begin(), mass.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Json out = Json::array();
  for (const auto& [p, i] : mass)
    out.push_back({{"place", places[i].name},
                   {"p", p},
                   {"parent", place_json(places[i].parent, background)}});
  out.push_back({{"place", nullptr}, {"p", std::max(outside, 0.0)}});
  return out;
}

/// The expected number of objects like those asked for that were never detected: in the place that
/// was asked for, else in each where it is at least kLeastShown.
Json undetected_json(const Snapshot& snapshot, const Parameters& asked) {
  const Background& background = *snapshot.background;
  Json out = Json::array();
  for (int i = 0; i < static_cast<int>(background.knowledge.places.size()); ++i) {
    if (asked.place >= 0 && i != asked.place) continue;
    const double expected =
        undetected(*snapshot.belief, snapshot.utime(), asked.description, i, background);
    if (expected >= kLeastShown)
      out.push_back({{"place", background.knowledge.places[i].name}, {"expected", expected}});
  }
  return out;
}

}  // namespace

HttpResponse answer(const HttpTarget& target, const Snapshot& snapshot, const FramesAt& frames_at) {
  constexpr std::string_view kObject = "/v1/objects/";
  const auto result = [&]() -> Result<Json> {
    if (target.path == "/v1/objects") return answer_objects(target, snapshot);
    if (target.path == "/v1/where") return answer_where(target, snapshot);
    if (target.path == "/v1/count") return answer_count(target, snapshot);
    if (target.path == "/v1/hypotheses") return answer_hypotheses(target, snapshot);
    if (target.path.starts_with(kObject))
      return answer_object(target.path.substr(kObject.size()), target, snapshot, frames_at);
    return Error{ErrorCode::kUnknown, "", "there is nothing at " + target.path};
  }();
  if (!result) return http_error(result.error());
  return {200, "application/json", result->dump() + "\n", {}};
}

Result<Json> answer_where(const HttpTarget& target, const Snapshot& snapshot) {
  const Background& background = *snapshot.background;
  auto asked = read_parameters(target, "description place object min_p", background);
  if (!asked) return asked.error();
  if (asked->object.empty() && !asked->filters())
    return invalid("object", "say which: object=ID, or a description such as class=cup");

  const Utime now = snapshot.utime();
  struct Candidate {
    ObjectBelief object;
    double match;
  };
  std::vector<Candidate> candidates;
  for (auto& object : read_objects(*snapshot.belief, now, 0, background)) {
    if (!asked->object.empty() && !object.anchor->is_called(asked->object)) continue;
    double fit = match(object, asked->description, background);
    if (asked->place >= 0) fit *= object.in_place(asked->place, background);
    if (asked->object.empty() && object.p * fit < asked->min_p.value_or(kLeastShown)) continue;
    candidates.push_back({std::move(object), fit});
  }
  if (candidates.empty() && !asked->object.empty())
    return Error{ErrorCode::kUnknown, "object", "there is no object \"" + asked->object + "\""};
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.object.p * a.match > b.object.p * b.match;
  });

  // Who asks for one object asks, as to what has not been seen, for its like.
  if (!asked->object.empty() && background.knowledge.class_attribute >= 0)
    asked->description.terms.push_back(
        {background.knowledge.class_attribute, candidates.front().object.shown().top_class()});

  Json answers = Json::array();
  for (const auto& [object, fit] : candidates) {
    const Gaussian where = object.moments(background);
    answers.push_back({{"object", object.anchor->id()},
                       {"p", object.p},
                       {"match", fit},
                       {"position", position_json(where.mean, background.dims)},
                       {"covariance", covariance_json(where.covariance, background.dims)},
                       {"last_seen", object.last_seen()},
                       {"places", places_json(object, background)}});
  }
  return Json{{"utime", now},
              {"answers", std::move(answers)},
              {"undetected", undetected_json(snapshot, *asked)}};
}

Result<Json> answer_count(const HttpTarget& target, const Snapshot& snapshot) {
  const Background& background = *snapshot.background;
  auto asked = read_parameters(target, "description place", background);
  if (!asked) return asked.error();
  const Utime now = snapshot.utime();
  const auto distribution =
      count_distribution(*snapshot.belief, now, asked->description, asked->place, background);
  double expected = 0;
  for (std::size_t n = 0; n < distribution.size(); ++n)
    expected += static_cast<double>(n) * distribution[n];
  return Json{{"utime", now},
              {"distribution", distribution},
              {"expected", expected},
              {"undetected",
               undetected(*snapshot.belief, now, asked->description, asked->place, background)}};
}

}  // namespace anchord
