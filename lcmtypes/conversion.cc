#include "lcmtypes/conversion.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "lcmtypes/names.h"

namespace anchord {
namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "encode() of a malformed message: %s\n", what);
  std::abort();
}

std::optional<View> from_lcm(const view_t& message) {
  if (message.type == view_t::CONFIGURED) return std::nullopt;
  View view;
  view.type = static_cast<View::Type>(message.type);
  if (view.type == View::Type::kSector || view.type == View::Type::kFrustum) {
    std::ranges::copy(message.range, view.range.begin());
  }
  if (view.type == View::Type::kSector) {
    std::ranges::copy(message.bearing, view.bearing.begin());
    std::ranges::copy(message.elevation, view.elevation.begin());
  }
  if (view.type == View::Type::kFrustum) {
    view.hfov = message.hfov;
    view.vfov = message.vfov;
  }
  for (const auto& point : message.points) view.points.push_back({point[0], point[1]});
  return view;
}

view_t to_lcm(const View& view) {
  view_t message{};
  message.type = static_cast<std::int8_t>(view.type);
  if (view.type == View::Type::kSector || view.type == View::Type::kFrustum) {
    std::ranges::copy(view.range, message.range);
  }
  if (view.type == View::Type::kSector) {
    std::ranges::copy(view.bearing, message.bearing);
    std::ranges::copy(view.elevation, message.elevation);
  }
  if (view.type == View::Type::kFrustum) {
    message.hfov = view.hfov;
    message.vfov = view.vfov;
  }
  if (view.type == View::Type::kPolygon) {
    for (const auto& point : view.points) message.points.push_back({point[0], point[1]});
  }
  message.num_points = static_cast<std::int32_t>(message.points.size());
  return message;
}

Detection from_lcm(const detection_t& message) {
  Detection detection;
  const double* numbers = message.measurement;
  if (message.kind == detection_t::POLAR) {
    detection.measurement =
        PolarMeasurement{numbers[0], numbers[1], numbers[2], message.covariance};
  } else {
    const int dims = message.num_covariance == 4 ? 2 : 3;
    detection.measurement = CartesianMeasurement{{numbers, numbers + dims}, message.covariance};
  }
  if (message.has_score) detection.score = message.score;
  if (message.has_yaw) detection.yaw = message.yaw;
  detection.object = message.object;
  detection.attributes = from_lcm(message.attributes);
  return detection;
}

detection_t to_lcm(const Detection& detection) {
  detection_t message{};
  if (const auto* polar = std::get_if<PolarMeasurement>(&detection.measurement)) {
    message.kind = detection_t::POLAR;
    message.measurement[0] = polar->range;
    message.measurement[1] = polar->bearing;
    message.measurement[2] = polar->elevation;
    message.covariance = polar->variance;
  } else {
    const auto& cartesian = std::get<CartesianMeasurement>(detection.measurement);
    const std::size_t dims = cartesian.position.size();
    require(dims == 2 || dims == 3, "a position has 2 or 3 numbers");
    message.kind = detection_t::POSITION;
    // A covariance of 4 numbers says that there is no z.
    const std::size_t used = cartesian.covariance.size() == 4 ? 2 : dims;
    std::copy_n(cartesian.position.begin(), used, message.measurement);
    message.covariance = cartesian.covariance;
  }
  message.num_covariance = static_cast<std::int32_t>(message.covariance.size());
  message.has_score = detection.score.has_value();
  message.score = detection.score.value_or(0);
  message.has_yaw = detection.yaw.has_value();
  message.yaw = detection.yaw.value_or(0);
  message.object = wire_text(detection.object);
  message.attributes = to_lcm(detection.attributes);
  message.num_attributes = static_cast<std::int32_t>(message.attributes.size());
  return message;
}

RegionOfInterest from_lcm(const region_t& message) {
  RegionOfInterest region;
  region.kind = static_cast<RegionOfInterest::Kind>(message.kind);
  region.p = message.p;
  if (region.kind == RegionOfInterest::Kind::kEllipsoid) {
    std::ranges::copy(message.center, region.center.begin());
    std::ranges::copy(message.covariance, region.covariance.begin());
    region.radius = message.radius;
  } else {
    for (const auto& point : message.polygon) region.polygon.push_back({point[0], point[1]});
    std::ranges::copy(message.z, region.z.begin());
  }
  return region;
}

region_t to_lcm(const RegionOfInterest& region) {
  region_t message{};
  message.kind = static_cast<std::int8_t>(region.kind);
  message.p = region.p;
  if (region.kind == RegionOfInterest::Kind::kEllipsoid) {
    std::ranges::copy(region.center, message.center);
    std::ranges::copy(region.covariance, message.covariance);
    message.radius = region.radius;
  } else {
    for (const auto& point : region.polygon) message.polygon.push_back({point[0], point[1]});
    std::ranges::copy(region.z, message.z);
  }
  message.num_points = static_cast<std::int32_t>(message.polygon.size());
  return message;
}

template <typename To, typename From>
std::vector<To> each(const std::vector<From>& list, To (*convert)(const From&)) {
  std::vector<To> out;
  out.reserve(list.size());
  for (const From& one : list) out.push_back(convert(one));
  return out;
}

}  // namespace

std::string wire_text(const std::string& value) {
  require(value.find('\0') == std::string::npos, "a text holds a NUL");
  return value;
}

Pose from_lcm(const pose_t& message) {
  Pose pose;
  std::ranges::copy(message.position, pose.position.begin());
  std::ranges::copy(message.orientation, pose.orientation.begin());
  std::ranges::copy(message.covariance, pose.covariance.begin());
  return pose;
}

pose_t to_lcm(const Pose& pose) {
  pose_t message{};
  std::ranges::copy(pose.position, message.position);
  std::ranges::copy(pose.orientation, message.orientation);
  std::ranges::copy(pose.covariance, message.covariance);
  return message;
}

AttributeReport from_lcm(const attribute_t& message) {
  if (message.kind == attribute_t::SCALAR) {
    return {message.name, ScalarReport{message.mean, message.variance}};
  }
  SymbolReport report;
  for (std::size_t i = 0; i < message.symbols.size(); ++i) {
    report.probabilities.emplace_back(message.symbols[i], message.probabilities[i]);
  }
  return {message.name, std::move(report)};
}

attribute_t to_lcm(const AttributeReport& report) {
  attribute_t message{};
  message.name = wire_text(report.name);
  if (const auto* scalar = std::get_if<ScalarReport>(&report.value)) {
    message.kind = attribute_t::SCALAR;
    message.mean = scalar->mean;
    message.variance = scalar->variance;
    return message;
  }
  message.kind = attribute_t::SYMBOLS;
  for (const auto& [symbol, probability] : std::get<SymbolReport>(report.value).probabilities) {
    message.symbols.push_back(wire_text(symbol));
    message.probabilities.push_back(probability);
  }
  message.num_symbols = static_cast<std::int32_t>(message.symbols.size());
  return message;
}

std::vector<AttributeReport> from_lcm(const std::vector<attribute_t>& messages) {
  return each<AttributeReport>(messages, from_lcm);
}

std::vector<attribute_t> to_lcm(const std::vector<AttributeReport>& reports) {
  return each<attribute_t>(reports, to_lcm);
}

std::vector<RegionOfInterest> from_lcm(const std::vector<region_t>& messages) {
  return each<RegionOfInterest>(messages, from_lcm);
}

std::vector<region_t> to_lcm(const std::vector<RegionOfInterest>& regions) {
  return each<region_t>(regions, to_lcm);
}

Frame from_lcm(const frame_t& message) {
  Frame frame;
  frame.utime = message.utime;
  frame.robot = message.robot;
  frame.sensor = message.sensor;
  if (message.has_pose) frame.pose = from_lcm(message.pose);
  frame.view = from_lcm(message.view);
  frame.detections.reserve(message.detections.size());
  for (const detection_t& detection : message.detections) {
    frame.detections.push_back(from_lcm(detection));
  }
  return frame;
}

frame_t to_lcm(const Frame& frame, std::int64_t seq) {
  frame_t message{};
  message.utime = frame.utime;
  message.seq = seq;
  message.robot = wire_text(frame.robot);
  message.sensor = wire_text(frame.sensor);
  message.has_pose = frame.pose.has_value();
  if (frame.pose) message.pose = to_lcm(*frame.pose);
  if (frame.view) {
    message.view = to_lcm(*frame.view);
  } else {
    message.view.type = view_t::CONFIGURED;
  }
  message.detections.reserve(frame.detections.size());
  for (const Detection& detection : frame.detections) {
    message.detections.push_back(to_lcm(detection));
  }
  message.num_detections = static_cast<std::int32_t>(message.detections.size());
  return message;
}

Status check_repeats(const std::vector<attribute_t>& attributes, const Field& list) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    const attribute_t& attribute = attributes[i];
    names.push_back(attribute.name);
    const int symbol = first_repeated({attribute.symbols.begin(), attribute.symbols.end()});
    if (symbol >= 0) {
      const Field where = list.element(i);
      const Field symbols = where.member("symbols");
      return invalid(symbols.element(symbol).text(), "this symbol is there already");
    }
  }
  const int repeated = first_repeated(names);
  if (repeated < 0) return Done{};
  return invalid(list.element(repeated).text(), "this attribute is there already");
}

Status check_repeats(const frame_t& frame, const Field& field) {
  const Field detections = field.member("detections");
  for (std::size_t i = 0; i < frame.detections.size(); ++i) {
    const Field detection = detections.element(i);
    const Status unique =
        check_repeats(frame.detections[i].attributes, detection.member("attributes"));
    if (!unique) return unique;
  }
  return Done{};
}

}  // namespace anchord
