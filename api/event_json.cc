#include "api/event_json.h"

#include <array>
#include <utility>

#include "api/json_fields.h"
#include "api/json_text.h"
#include "lcmtypes/names.h"

namespace anchord {
namespace {

using Json = nlohmann::json;
using Kind = Event::Kind;

constexpr std::array<std::pair<Kind, const char*>, 10> kKinds{{{Kind::kMissing, "missing"},
                                                               {Kind::kGrasped, "grasped"},
                                                               {Kind::kCarried, "carried"},
                                                               {Kind::kPlaced, "placed"},
                                                               {Kind::kMoved, "moved"},
                                                               {Kind::kRemoved, "removed"},
                                                               {Kind::kNamed, "named"},
                                                               {Kind::kJoined, "joined"},
                                                               {Kind::kDropped, "dropped"},
                                                               {Kind::kUndone, "undone"}}};

class EventReader : public JsonFields {
 public:
  explicit EventReader(int dims) : dims_(dims) {}

  bool read_event(const Json& json, Event& event) {
    if (!check_object(json, top_)) return false;
    const Json* utime = need(json, top_, "utime");
    const Json* kind = need(json, top_, "event");
    return utime && kind && read(*utime, top_.member("utime"), event.utime) &&
           read_kind(*kind, top_.member("event"), event.kind) && needed(json, event.kind) &&
           text(json, "robot", event.robot) && text(json, "object", event.object) &&
           text(json, event.kind == Kind::kNamed ? "name" : "other", event.other) &&
           text(json, "place", event.place) && text(json, "sensor", event.sensor) &&
           position(json, event) && regions(json, event.regions) &&
           integer(json, "number", event.undone);
  }

 private:
  bool read_kind(const Json& value, const Field& field, Kind& out) {
    std::string name;
    if (!read(value, field, name)) return false;
    std::string known;
    for (const auto& [kind, called] : kKinds) {
      if (name == called) {
        out = kind;
        return true;
      }
      known += (known.empty() ? "" : ", ") + std::string(called);
    }
    return refuse(field, "must be one of " + known);
  }

  /// What an Event cannot tell from a default; the rest is checked where it is used.
  bool needed(const Json& json, Kind kind) {
    if (kind == Kind::kNamed) return need(json, top_, "name");
    if (kind == Kind::kUndone) return need(json, top_, "number");
    return true;
  }

  bool text(const Json& json, const char* key, std::string& out) {
    const Json* value = find(json, key);
    return !value || value->is_null() || read(*value, top_.member(key), out);
  }

  bool integer(const Json& json, const char* key, std::int64_t& out) {
    const Json* value = find(json, key);
    return !value || read(*value, top_.member(key), out);
  }

  /// Those of a 3-D world are taken in a 2-D one too.
  bool numbers(const Json& value, const char* key, std::size_t in_2d, std::size_t in_3d,
               std::vector<double>& out) {
    const Field field = top_.member(key);
    return dims_ == 2 ? read_numbers(value, field, {in_2d, in_3d}, out)
                      : read_numbers(value, field, {in_3d}, out);
  }

  bool position(const Json& json, Event& event) {
    std::vector<double> read;
    if (const Json* value = find(json, "position")) {
      if (!numbers(*value, "position", 2, 3, read)) return false;
      auto& out = event.position.emplace();
      std::copy(read.begin(), read.end(), out.begin());
    }
    if (const Json* value = find(json, "covariance")) {
      if (!numbers(*value, "covariance", 4, 9, read)) return false;
      auto& out = event.covariance.emplace();
      const std::size_t n = read.size() == 4 ? 2 : 3;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) out[3 * i + j] = read[n * i + j];
    }
    return true;
  }

  bool regions(const Json& json, std::vector<RegionOfInterest>& out) {
    const Json* list = find(json, "regions");
    if (!list) return true;
    const Field field = top_.member("regions");
    if (!check_array(*list, field, kMaxRegions)) return false;
    for (std::size_t i = 0; i < list->size(); ++i)
      if (!region((*list)[i], field.element(i), out.emplace_back())) return false;
    return true;
  }

  bool region(const Json& json, const Field& field, RegionOfInterest& out) {
    if (!check_object(json, field)) return false;
    if (const Json* p = find(json, "p"); p && !read(*p, field.member("p"), out.p)) return false;
    if (const Json* polygon = find(json, "polygon")) {
      out.kind = RegionOfInterest::Kind::kPrism;
      const Field points = field.member("polygon");
      if (!check_array(*polygon, points, kMaxPolygonPoints)) return false;
      for (std::size_t i = 0; i < polygon->size(); ++i)
        if (!read((*polygon)[i], points.element(i), out.polygon.emplace_back())) return false;
      const Json* z = find(json, "z");
      return !z || read(*z, field.member("z"), out.z);
    }
    const Json* center = need(json, field, "center");
    const Json* covariance = need(json, field, "covariance");
    const Json* radius = need(json, field, "radius");
    return center && covariance && radius && read(*center, field.member("center"), out.center) &&
           read(*covariance, field.member("covariance"), out.covariance) &&
           read(*radius, field.member("radius"), out.radius);
  }

  const Field top_{};  // the document itself
  const int dims_;
};

}  // namespace

Result<Event> event_from_json(const Json& json, int dims) {
  EventReader reader(dims);
  Event event;
  if (!reader.read_event(json, event)) return reader.error();
  return event;
}

Result<Event> parse_event(std::string_view text, int dims) {
  const auto json = parse_json(text);
  if (!json) return json.error();
  return event_from_json(*json, dims);
}

const char* to_string(Kind kind) { return kKinds[static_cast<std::size_t>(kind)].second; }

Json to_json(const RegionOfInterest& region) {
  if (region.kind == RegionOfInterest::Kind::kPrism)
    return {{"p", region.p}, {"polygon", region.polygon}, {"z", region.z}};
  return {{"p", region.p},
          {"center", region.center},
          {"covariance", region.covariance},
          {"radius", region.radius}};
}

Json to_json(const Event& event) {
  Json out{{"utime", event.utime}, {"event", to_string(event.kind)}};
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) out[key] = value;
  };
  add("robot", event.robot);
  add("object", event.object);
  if (event.kind == Kind::kNamed)
    out["name"] = event.other;
  else
    add("other", event.other);
  add("place", event.place);
  add("sensor", event.sensor);
  if (event.position) out["position"] = *event.position;
  if (event.covariance) out["covariance"] = *event.covariance;
  for (const RegionOfInterest& region : event.regions) out["regions"].push_back(to_json(region));
  if (event.undone != 0) out["number"] = event.undone;
  return out;
}

}  // namespace anchord
