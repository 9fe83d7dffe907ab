#include "api/foxglove_schemas.h"

#include <initializer_list>
#include <utility>

namespace anchord::foxglove {
namespace {

using nlohmann::json;

using Members = std::initializer_list<std::pair<const char*, json>>;

json object(const char* title, Members members) {
  json properties = json::object();
  for (const auto& [name, schema] : members) properties[name] = schema;
  return {{"title", title}, {"type", "object"}, {"properties", std::move(properties)}};
}

json list_of(json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

const json kNumber{{"type", "number"}}, kInteger{{"type", "integer"}}, kText{{"type", "string"}},
    kTruth{{"type", "boolean"}};

json time(const char* title) { return object(title, {{"sec", kInteger}, {"nsec", kInteger}}); }

json vector() {
  return object("foxglove.Vector3", {{"x", kNumber}, {"y", kNumber}, {"z", kNumber}});
}

json pose() {
  const json quaternion = object("foxglove.Quaternion",
                                 {{"x", kNumber}, {"y", kNumber}, {"z", kNumber}, {"w", kNumber}});
  return object("foxglove.Pose", {{"position", vector()}, {"orientation", quaternion}});
}

json color() {
  return object("foxglove.Color", {{"r", kNumber}, {"g", kNumber}, {"b", kNumber}, {"a", kNumber}});
}

json solid(const char* title) {
  return object(title, {{"pose", pose()}, {"size", vector()}, {"color", color()}});
}

json scene_update() {
  const json deletion = object("foxglove.SceneEntityDeletion",
                               {{"timestamp", time("time")}, {"type", kInteger}, {"id", kText}});
  const json text = object("foxglove.TextPrimitive", {{"pose", pose()},
                                                      {"billboard", kTruth},
                                                      {"font_size", kNumber},
                                                      {"scale_invariant", kTruth},
                                                      {"color", color()},
                                                      {"text", kText}});
  const json none = list_of({{"type", "object"}});
  const json entity = object(
      "foxglove.SceneEntity",
      {{"timestamp", time("time")},
       {"frame_id", kText},
       {"id", kText},
       {"lifetime", time("duration")},
       {"frame_locked", kTruth},
       {"metadata", list_of(object("foxglove.KeyValuePair", {{"key", kText}, {"value", kText}}))},
       {"arrows", none},
       {"cubes", list_of(solid("foxglove.CubePrimitive"))},
       {"spheres", list_of(solid("foxglove.SpherePrimitive"))},
       {"cylinders", none},
       {"lines", none},
       {"triangles", none},
       {"texts", list_of(text)},
       {"models", none}});
  return object("foxglove.SceneUpdate",
                {{"deletions", list_of(deletion)}, {"entities", list_of(entity)}});
}

}  // namespace

json schema_of(const std::string& name) {
  if (name == "foxglove.SceneUpdate") return scene_update();
  if (name == "foxglove.PoseInFrame")
    return object("foxglove.PoseInFrame",
                  {{"timestamp", time("time")}, {"frame_id", kText}, {"pose", pose()}});
  return object("foxglove.Log", {{"timestamp", time("time")},
                                 {"level", kInteger},
                                 {"message", kText},
                                 {"name", kText},
                                 {"file", kText},
                                 {"line", kInteger}});
}

}  // namespace anchord::foxglove
