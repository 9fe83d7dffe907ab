#include "geometry/view.h"
#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr Range kAngle{-2 * kPi, 2 * kPi};
constexpr Range kElevation{-kPi / 2, kPi / 2};
constexpr Range kOpening{0, kPi, true, true};

/// The numbers of a view, where they are right.
class ViewReader {
 public:
  ViewReader(const JsonValue& view, bool& right) : view_(view), right_(right) {}

  void pair(const char* key, const Range& range, std::array<double, 2>& target) {
    if (const auto both = member(key, "two numbers")) {
      const auto numbers = both->numbers(2, range);
      if (numbers) target = {(*numbers)[0], (*numbers)[1]};
      right_ = right_ && numbers;
    }
  }
  void opening(const char* key, double& target) {
    if (const auto angle = member(key, "a full opening angle, radians")) {
      const auto number = angle->number(kOpening);
      target = number.value_or(target);
      right_ = right_ && number;
    }
  }
  void points(std::vector<std::array<double, 2>>& target) {
    if (const auto corners = member("points", "[[x, y], ...], metres")) {
      const auto polygon = corners->polygon();
      right_ = right_ && polygon;
      if (!polygon) return;
      for (const Eigen::Vector2d& corner : *polygon) target.push_back({corner.x(), corner.y()});
    }
  }

 private:
  std::optional<JsonValue> member(const char* key, const char* shape) {
    auto value = view_.find(key);
    if (!value) {
      view_.mistake_at(view_.path_of(key), std::string("is missing; it must be ") + shape);
      right_ = false;
    }
    return value;
  }

  const JsonValue& view_;
  bool& right_;
};

}  // namespace

std::optional<View> read_view(const JsonValue& value, int dims) {
  const std::vector<std::string> types = {"none", "world", "sector", "frustum", "polygon"};
  const auto type = value.find("type");
  if (!value.object()) return std::nullopt;
  if (!type) {
    value.mistake_at(value.path_of("type"),
                     R"(is missing; it must be "none", "world", "sector", "frustum" or "polygon")");
    return std::nullopt;
  }
  const auto index = type->one_of(types, "type of view");
  if (!index) return std::nullopt;
  View view;
  view.type = static_cast<View::Type>(*index);
  bool right = true;
  ViewReader reader(value, right);
  switch (view.type) {
    case View::Type::kNone:
    case View::Type::kWorld:
      right = value.object_of({"type"});
      break;
    case View::Type::kSector:
      value.object_of({"type", "range", "bearing", "elevation"});
      reader.pair("range", kNotNegative, view.range);
      reader.pair("bearing", kAngle, view.bearing);
      if (value.find("elevation")) reader.pair("elevation", kElevation, view.elevation);
      break;
    case View::Type::kFrustum:
      value.object_of({"type", "range", "hfov", "vfov"});
      reader.pair("range", kNotNegative, view.range);
      reader.opening("hfov", view.hfov);
      if (dims == 3 || value.find("vfov")) reader.opening("vfov", view.vfov);
      break;
    case View::Type::kPolygon:
      value.object_of({"type", "points"});
      reader.points(view.points);
      break;
  }
  if (!right) return std::nullopt;
  const auto placed = MapView::place(view, std::nullopt, dims);
  if (placed.ok()) return view;
  const std::string field = placed.error().field;  // below "view"
  const std::string below = field.rfind("view.", 0) == 0 ? field.substr(5) : "";
  value.mistake_at(below.empty() ? value.path() : value.path_of(below), placed.error().message);
  return std::nullopt;
}

}  // namespace anchord
