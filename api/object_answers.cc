#include <algorithm>

#include "api/answers.h"

namespace anchord {
namespace {

constexpr double kLeastShown = 0.001;

Json object_json(const ObjectBelief& object, const Background& background) {
  const Gaussian where = object.moments(background);
  Json out{{"id", object.anchor->id()},
           {"p", object.p},
           {"position", position_json(where.mean, background.dims)},
           {"covariance", covariance_json(where.covariance, background.dims)}};
  const Leaf* leaf = &object.shown();
  out["velocity"] = position_json(velocity_of(*leaf, background), background.dims);
  out["attributes"] = attributes_json(object, background);
  out["last_seen"] = object.last_seen();
  out["place"] = place_json(object.place(background), background);
  out["in_best"] = object.in_best;
  add_shape(out, *leaf, background);
  add_said(out, *object.anchor);
  return out;
}

/// The behaviour models of one leaf, each with where it believes the object to be.
Json model_list(const Leaf& leaf, const Background& background) {
  Json out = Json::array();
  const auto& models = background.object_class(leaf.model_class).models;
  for (std::size_t m = 0; m < leaf.models.size(); ++m) {
    Json model{{"kind", to_string(models[m].kind)}, {"weight", leaf.models[m].weight}};
    if (const auto* kinematic = std::get_if<Kinematic>(&leaf.models[m].density)) {
      model["detectable"] = models[m].detectable;
      model["position"] = position_json(kinematic->position, background.dims);
      model["covariance"] = covariance_json(kinematic->pp, background.dims);
    } else {
      const auto& somewhere = std::get<Somewhere>(leaf.models[m].density);
      model["place"] = place_json(background.place_of(*somewhere.footprint()), background);
    }
    out.push_back(std::move(model));
  }
  return out;
}

/// The versions of an object, likeliest first: where else it may be, and what it may be.
Json alternatives_json(const ObjectBelief& object, const Background& background) {
  std::vector<const ObjectBelief::Version*> versions;
  for (const auto& version : object.versions)
    if (version.weight(object.p) >= kLeastShown) versions.push_back(&version);
  std::stable_sort(versions.begin(), versions.end(), [&](const auto* a, const auto* b) {
    return a->weight(object.p) > b->weight(object.p);
  });
  Json out = Json::array();
  for (const auto* version : versions) {
    const Gaussian where = moments(version->leaf);
    ObjectBelief alone = object;
    alone.versions = {*version};
    alone.p = version->probability * version->leaf.existence;
    out.push_back({{"p", version->weight(object.p)},
                   {"position", position_json(where.mean, background.dims)},
                   {"covariance", covariance_json(where.covariance, background.dims)},
                   {"place", place_json(alone.place(background), background)},
                   {"class", background.object_class(version->leaf.top_class()).name}});
  }
  return out;
}

}  // namespace

Result<Json> answer_objects(const HttpTarget& target, const Snapshot& snapshot) {
  const Background& background = *snapshot.background;
  auto asked = read_parameters(target, "description place min_p", background);
  if (!asked) return asked.error();
  std::vector<ObjectBelief> matching;
  for (auto& object : read_objects(*snapshot.belief, snapshot.utime(),
                                   asked->min_p.value_or(kLeastShown), background)) {
    if (match(object, asked->description, background) < 0.5) continue;
    if (asked->place >= 0 && !object.mostly_in(asked->place, background)) continue;
    matching.push_back(std::move(object));
  }
  std::stable_sort(matching.begin(), matching.end(),
                   [](const auto& a, const auto& b) { return a.p > b.p; });
  Json objects = Json::array();
  for (const auto& object : matching) objects.push_back(object_json(object, background));
  return Json{{"utime", snapshot.utime()}, {"objects", std::move(objects)}};
}

Result<Json> answer_object(const std::string& id, const HttpTarget& target,
                           const Snapshot& snapshot, const FramesAt& frames_at) {
  const Background& background = *snapshot.background;
  if (auto none = read_parameters(target, "", background); !none) return none.error();
  for (const auto& object : read_objects(*snapshot.belief, snapshot.utime(), 0, background)) {
    if (!object.anchor->is_called(id)) continue;
    Json out{{"utime", snapshot.utime()}};
    out.update(object_json(object, background));
    out["models"] = model_list(object.shown(), background);
    out["alternatives"] = alternatives_json(object, background);
    if (frames_at) out["seen"] = sighting_json(object, frames_at, background);
    return out;
  }
  return Error{ErrorCode::kUnknown, "object", "there is no object \"" + id + "\""};
}

}  // namespace anchord
