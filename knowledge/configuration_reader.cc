#include "knowledge/configuration_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace anchord {
namespace {

constexpr std::size_t kMostPlaces = 4000;

double cells(const Knowledge& knowledge, double cell) {
  const Eigen::Vector3d size = knowledge.bounds_max - knowledge.bounds_min;
  return std::ceil(size.x() / cell) * std::ceil(size.y() / cell);
}

void read_bounds(const JsonValue& bounds, Knowledge& knowledge) {
  if (!bounds.object_of({"min", "max"})) return;
  for (const auto& [key, corner] : {std::make_pair("min", &knowledge.bounds_min),
                                    std::make_pair("max", &knowledge.bounds_max)}) {
    const auto given = bounds.find(key);
    if (!given) bounds.mistake_at(bounds.path_of(key), "is missing: a corner of the world, metres");
    const auto point = given ? given->point(knowledge.dims) : std::nullopt;
    if (!point) return;
    *corner = *point;
  }
  for (int axis = 0; axis < knowledge.dims; ++axis) {
    if (!(knowledge.bounds_min[axis] < knowledge.bounds_max[axis])) {
      bounds.mistake("min must lie below max on every axis");
      knowledge.bounds_max = knowledge.bounds_min;
      return;
    }
  }
}

void read_cell(const JsonValue& world, Knowledge& knowledge) {
  if (world.find("cell")) {
    world.read("cell", knowledge.cell, kPositive);
    if (cells(knowledge, knowledge.cell) > kMaxCells) {
      world.mistake_at(world.path_of("cell"),
                       "makes more than 4000000 cells of the world; raise it");
    }
  } else {
    while (cells(knowledge, knowledge.cell) > kMaxCells) knowledge.cell *= 2;
  }
}

/// A wall: [[x, y], [x, y]], or {"line": that, "z": [least, most]} in a 3-D world.
void read_wall(const JsonValue& entry, Knowledge& knowledge) {
  const bool low = entry.json().is_object();
  if (low && !entry.object_of({"line", "z"})) return;
  const auto line = low ? entry.find("line") : std::optional(entry);
  if (!line) entry.mistake_at(entry.path_of("line"), "is missing: [[x, y], [x, y]], metres");
  const auto ends = line ? line->elements(2) : std::vector<JsonValue>{};
  if (ends.size() != 2) {
    if (line && line->json().is_array())
      line->mistake("must be two points: [[x, y], [x, y]], metres");
    return;
  }
  const auto from = ends[0].point(2), to = ends[1].point(2);
  if (!from || !to) return;
  if (*from == *to) line->mistake("must be two different points");
  Wall wall{{from->x(), from->y()}, {to->x(), to->y()}};
  if (const auto z = low ? entry.find("z") : std::nullopt) {
    if (knowledge.dims == 2) z->mistake("a 2-D world has no heights");
    std::tie(wall.z_min, wall.z_max) =
        z->interval(kCoordinate).value_or(std::pair(wall.z_min, wall.z_max));
  }
  knowledge.walls.push_back(wall);
}

/// Sets parents and depths; `parents` holds names, empty for none.
void connect(const std::vector<std::optional<JsonValue>>& parents, std::vector<Place>& places) {
  const std::vector<std::string> known = names(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (parents[i]) places[i].parent = parents[i]->one_of(known, "place").value_or(-1);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int self = static_cast<int>(i);
    int ancestor = places[i].parent;
    while (ancestor >= 0 && ancestor != self && places[i].depth < static_cast<int>(places.size())) {
      ++places[i].depth;
      ancestor = places[static_cast<std::size_t>(ancestor)].parent;
    }
    if (ancestor == self) parents[i]->mistake("makes the place lie in itself");
  }
}

}  // namespace

std::vector<std::string> names(const std::vector<Place>& places) {
  std::vector<std::string> all;
  for (const Place& place : places) all.push_back(place.name);
  return all;
}

void read_world(const JsonValue& root, Knowledge& knowledge) {
  const auto world = root.find("world");
  if (!world) {
    root.mistake_at("world", "is missing; it must have at least \"bounds\"");
    return;
  }
  if (!world->object_of(
          {"frame", "dimensions", "bounds", "cell", "max_lateness", "max_leap", "walls"}))
    return;
  world->read("frame", knowledge.map_frame);
  world->read("dimensions", knowledge.dims, 2, 3);
  world->read("max_lateness", knowledge.max_lateness, {0, 3600});
  world->read("max_leap", knowledge.max_leap, {1, 1e10});
  if (const auto bounds = world->find("bounds")) {
    read_bounds(*bounds, knowledge);
  } else {
    world->mistake_at("world.bounds",
                      R"(is missing; it must be {"min": [...], "max": [...]}, metres)");
  }
  read_cell(*world, knowledge);
  if (const auto walls = world->find("walls"))
    for (const JsonValue& entry : walls->elements(kMaxWalls)) read_wall(entry, knowledge);
}

void read_places(const JsonValue& root, Knowledge& knowledge) {
  const auto section = root.find("places");
  if (!section) return;
  std::map<std::string, std::string> paths;  // of each name
  std::vector<std::optional<JsonValue>> parents;
  for (const JsonValue& value : section->elements(kMostPlaces)) {
    if (!value.object_of({"name", "kind", "parent", "polygon", "z"})) continue;
    Place place;
    if (const auto name = value.find("name")) {
      place.name = name->name().value_or("");
      const auto [first, unique] = paths.try_emplace(place.name, value.path());
      if (!unique && !place.name.empty()) {
        name->mistake("\"" + place.name + "\" is the name of " + first->second + " already");
      }
    } else {
      value.mistake_at(value.path_of("name"), "is missing");
    }
    value.read("kind", place.kind);
    if (const auto polygon = value.find("polygon")) {
      place.region.polygon = polygon->polygon().value_or(std::vector<Eigen::Vector2d>{});
    } else {
      value.mistake_at(value.path_of("polygon"), "is missing; it must be [[x, y], ...], metres");
    }
    std::pair<double, double> z{knowledge.bounds_min.z(), knowledge.bounds_max.z()};
    if (const auto given = value.find("z")) z = given->interval(kCoordinate).value_or(z);
    place.region.z_min = z.first;
    place.region.z_max = z.second;
    knowledge.places.push_back(std::move(place));
    parents.push_back(value.find("parent"));
  }
  connect(parents, knowledge.places);
}

void read_limits(const JsonValue& root, Knowledge& knowledge) {
  const auto section = root.find("hypotheses");
  if (!section ||
      !section->object_of({"max", "min_weight", "gate_probability", "scan_depth", "min_existence",
                           "min_probability", "min_symbol", "frame_budget"})) {
    return;
  }
  constexpr int kMost = 1'000'000;
  Limits& limits = knowledge.limits;
  section->read("max", limits.max_hypotheses, 0, kMost);
  section->read("min_weight", limits.min_weight, kBelowCertain);
  section->read("gate_probability", limits.gate_probability, kAboveImpossible);
  section->read("scan_depth", limits.scan_depth, 0, kMost);
  section->read("min_existence", limits.min_existence, kBelowCertain);
  constexpr double kForgotten = 0.01;  // what may be somebody's other history stays
  limits.min_probability = kForgotten * limits.min_existence;
  section->read("min_probability", limits.min_probability, kBelowCertain);
  limits.min_symbol = std::min(limits.min_symbol, limits.min_weight);
  section->read("min_symbol", limits.min_symbol, {0, 0.1});
  section->read("frame_budget", limits.frame_budget, {0, 60});
}

void read_log_limits(const JsonValue& root, Knowledge& knowledge) {
  const auto section = root.find("log");
  if (!section || !section->object_of({"keep", "max_bytes", "history_grain"})) return;
  constexpr Range kSpan{0, 1e10};        // s
  constexpr Range kGrain{0, 1e6, true};  // s
  constexpr double kMostBytes = 1e15;    // a double counts as far
  section->read("keep", knowledge.log.keep, kSpan);
  section->read("history_grain", knowledge.log.history_grain, kGrain);
  if (const auto bytes = section->find("max_bytes")) {
    const auto most = bytes->number({0, kMostBytes});
    if (most && *most != std::floor(*most)) bytes->mistake("must be a whole number of bytes");
    knowledge.log.max_bytes = static_cast<std::int64_t>(most.value_or(0));
  }
}

Knowledge read_knowledge(const nlohmann::json& document, ConfigurationMistakes& mistakes) {
  Knowledge knowledge;
  const JsonValue root(document, "", mistakes);
  if (!root.object_of({"include", "world", "places", "attributes", "classes", "sensors",
                       "hypotheses", "maintenance", "log"})) {
    return knowledge;
  }
  read_world(root, knowledge);
  read_places(root, knowledge);
  read_attributes(root, knowledge);
  read_classes(root, knowledge);
  read_sensors(root, knowledge);
  read_limits(root, knowledge);
  read_maintenance(root, knowledge);
  read_log_limits(root, knowledge);
  return knowledge;
}

}  // namespace anchord
