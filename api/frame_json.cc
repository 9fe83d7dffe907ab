#include "api/frame_json.h"

#include <iterator>
#include <string>
#include <utility>
#include <variant>

#include "api/json_fields.h"
#include "api/json_text.h"
#include "lcmtypes/names.h"

namespace anchord {
namespace {

using nlohmann::json;

/// The types of a view in the order of View::Type.
constexpr const char* kViewTypes[] = {"none", "world", "sector", "frustum", "polygon"};

/// Reads what a frame consists of.
class FrameReader : public JsonFields {
 public:
  bool read(const json& value, const Field& field, Frame& out) {
    if (!check_object(value, field) || !needed(value, field, "utime", out.utime) ||
        !needed(value, field, "sensor", out.sensor) ||
        !optional(value, field, "robot", out.robot) || !optional(value, field, "pose", out.pose) ||
        !optional(value, field, "view", out.view)) {
      return false;
    }
    if (out.sensor.empty()) return refuse(field.member("sensor"), "must not be empty");
    const json* list = need(value, field, "detections");
    const Field detections = field.member("detections");
    if (!list || !check_array(*list, detections, kMaxDetections)) return false;
    out.detections.resize(list->size());
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (!read((*list)[i], detections.element(i), out.detections[i])) return false;
    }
    return true;
  }

 private:
  using JsonFields::read;

  template <typename T>
  bool needed(const json& from, const Field& field, const char* key, T& out) {
    const json* value = need(from, field, key);
    return value && read(*value, field.member(key), out);
  }
  template <typename T>
  bool optional(const json& from, const Field& field, const char* key, T& out) {
    const json* value = find(from, key);
    return !value || read(*value, field.member(key), out);
  }
  template <typename T>
  bool optional(const json& from, const Field& field, const char* key, std::optional<T>& out) {
    const json* value = find(from, key);
    return !value || read(*value, field.member(key), out.emplace());
  }
  bool optional_numbers(const json& from, const Field& field, const char* key, std::size_t count,
                        std::vector<double>& out) {
    const json* value = find(from, key);
    return !value || read_numbers(*value, field.member(key), {count}, out);
  }

  bool read(const json& value, const Field& field, Pose& out) {
    return check_object(value, field) && needed(value, field, "position", out.position) &&
           needed(value, field, "orientation", out.orientation) &&
           optional(value, field, "covariance", out.covariance);
  }

  bool read(const json& value, const Field& field, View& out) {
    std::string type;
    if (!check_object(value, field) || !needed(value, field, "type", type)) return false;
    const auto known = std::find(std::begin(kViewTypes), std::end(kViewTypes), type);
    if (known == std::end(kViewTypes)) {
      return refuse(field.member("type"), "must be none, world, sector, frustum or polygon");
    }
    out.type = static_cast<View::Type>(known - std::begin(kViewTypes));
    switch (out.type) {
      case View::Type::kSector:
        return needed(value, field, "range", out.range) &&
               needed(value, field, "bearing", out.bearing) &&
               optional(value, field, "elevation", out.elevation);
      case View::Type::kFrustum:
        return needed(value, field, "hfov", out.hfov) && optional(value, field, "vfov", out.vfov) &&
               needed(value, field, "range", out.range);
      case View::Type::kPolygon:
        return needed(value, field, "points", out.points);
      default:
        return true;
    }
  }

  bool read(const json& value, const Field& field, std::vector<std::array<double, 2>>& out) {
    if (!check_array(value, field, kMaxPolygonPoints)) return false;
    out.resize(value.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!read(value[i], field.element(i), out[i])) return false;
    }
    return true;
  }

  bool read(const json& value, const Field& field, Detection& out) {
    return check_object(value, field) && read_measurement(value, field, out) &&
           optional(value, field, "score", out.score) && optional(value, field, "yaw", out.yaw) &&
           optional(value, field, "object", out.object) &&
           optional(value, field, "attributes", out.attributes);
  }

  bool read_measurement(const json& value, const Field& field, Detection& out) {
    const json* position = find(value, "position");
    const json* polar = find(value, "polar");
    if (!position && !polar) return refuse(field, "must have position or polar");
    if (position && polar) return refuse(field, "must not have both position and polar");
    if (polar) {
      return read(*polar, field.member("polar"), out.measurement.emplace<PolarMeasurement>());
    }
    auto& measured = out.measurement.emplace<CartesianMeasurement>();
    if (!read_numbers(*position, field.member("position"), {2, 3}, measured.position)) return false;
    const std::size_t dims = measured.position.size();
    return optional_numbers(value, field, "covariance", dims * dims, measured.covariance);
  }

  bool read(const json& value, const Field& field, PolarMeasurement& out) {
    return check_object(value, field) && needed(value, field, "range", out.range) &&
           needed(value, field, "bearing", out.bearing) &&
           optional(value, field, "elevation", out.elevation) &&
           optional_numbers(value, field, "variance", 3, out.variance);
  }

  /// An object whose members are names.
  bool check_names(const json& value, const Field& field, std::size_t max_size) {
    if (!check_object(value, field)) return false;
    if (value.size() > max_size) {
      return refuse(field, "must have at most " + std::to_string(max_size) + " members");
    }
    for (const auto& [name, member] : value.items()) {
      const char* fault = name_fault(name);
      if (fault) return refuse(field, std::string("the name of a member ") + fault);
    }
    return true;
  }

  bool read(const json& value, const Field& field, std::vector<AttributeReport>& out) {
    if (!check_names(value, field, kMaxAttributes)) return false;
    for (const auto& [name, report] : value.items()) {
      const Field attribute = field.member(name);
      if (!check_object(report, attribute)) return false;
      const bool scalar = report.contains("mean") || report.contains("variance");
      AttributeReport& read_report = out.emplace_back();
      read_report.name = name;
      if (!(scalar ? read(report, attribute, read_report.value.emplace<ScalarReport>())
                   : read(report, attribute, read_report.value.emplace<SymbolReport>()))) {
        return false;
      }
    }
    return true;
  }

  bool read(const json& value, const Field& field, ScalarReport& out) {
    return needed(value, field, "mean", out.mean) && needed(value, field, "variance", out.variance);
  }

  bool read(const json& value, const Field& field, SymbolReport& out) {
    if (!check_names(value, field, kMaxSymbols)) return false;
    for (const auto& [symbol, probability] : value.items()) {
      double p = 0;
      if (!read(probability, field.member(symbol), p)) return false;
      out.probabilities.emplace_back(symbol, p);
    }
    return true;
  }
};

Result<Frame> read_frame(const json& value, const Field& field) {
  FrameReader reader;
  Frame frame;
  if (!reader.read(value, field, frame)) return reader.error();
  return frame;
}

json json_of(const View& view) {
  json value = {{"type", kViewTypes[static_cast<int>(view.type)]}};
  if (view.type == View::Type::kSector || view.type == View::Type::kFrustum) {
    value["range"] = view.range;
  }
  if (view.type == View::Type::kSector) {
    value["bearing"] = view.bearing;
    value["elevation"] = view.elevation;
  }
  if (view.type == View::Type::kFrustum) {
    value["hfov"] = view.hfov;
    value["vfov"] = view.vfov;
  }
  if (view.type == View::Type::kPolygon) value["points"] = view.points;
  return value;
}

json json_of(const AttributeReport& report) {
  if (const auto* scalar = std::get_if<ScalarReport>(&report.value)) {
    return {{"mean", scalar->mean}, {"variance", scalar->variance}};
  }
  json value = json::object();
  for (const auto& [symbol, p] : std::get<SymbolReport>(report.value).probabilities) {
    value[symbol] = p;
  }
  return value;
}

json json_of(const Detection& detection) {
  json value = json::object();
  if (const auto* polar = std::get_if<PolarMeasurement>(&detection.measurement)) {
    json& to = value["polar"] = {
        {"range", polar->range}, {"bearing", polar->bearing}, {"elevation", polar->elevation}};
    if (!polar->variance.empty()) to["variance"] = polar->variance;
  } else {
    const auto& cartesian = std::get<CartesianMeasurement>(detection.measurement);
    value["position"] = cartesian.position;
    if (!cartesian.covariance.empty()) value["covariance"] = cartesian.covariance;
  }
  if (detection.score) value["score"] = *detection.score;
  if (detection.yaw) value["yaw"] = *detection.yaw;
  if (!detection.object.empty()) value["object"] = detection.object;
  for (const AttributeReport& report : detection.attributes) {
    value["attributes"][report.name] = json_of(report);
  }
  return value;
}

}  // namespace

Result<Frame> frame_from_json(const nlohmann::json& value) { return read_frame(value, Field()); }

Result<Frame> parse_frame(std::string_view text) {
  const Result<json> value = parse_json(text);
  if (!value) return value.error();
  return frame_from_json(*value);
}

Result<std::vector<Frame>> parse_frames(std::string_view text) {
  const Result<json> value = parse_json(text);
  if (!value) return value.error();
  std::vector<Frame> frames;
  const std::size_t count = value->is_array() ? value->size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Field root;
    Result<Frame> frame =
        value->is_array() ? read_frame((*value)[i], root.element(i)) : read_frame(*value, root);
    if (!frame) return frame.error();
    frames.push_back(std::move(*frame));
  }
  return frames;
}

nlohmann::json to_json(const Frame& frame) {
  json value = {{"utime", frame.utime}, {"sensor", frame.sensor}, {"detections", json::array()}};
  if (!frame.robot.empty()) value["robot"] = frame.robot;
  if (frame.pose) {
    value["pose"] = {{"position", frame.pose->position},
                     {"orientation", frame.pose->orientation},
                     {"covariance", frame.pose->covariance}};
  }
  if (frame.view) value["view"] = json_of(*frame.view);
  for (const Detection& detection : frame.detections) {
    value["detections"].push_back(json_of(detection));
  }
  return value;
}

}  // namespace anchord
