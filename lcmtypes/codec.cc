#include "lcmtypes/codec.h"

#include <algorithm>
#include <anchord/frame_t.hpp>
#include <cstdio>
#include <cstdlib>
#include <variant>

namespace anchord {
namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "encode() of a malformed frame: %s\n", what);
  std::abort();
}

std::string text(const std::string& value) {
  require(value.find('\0') == std::string::npos, "a text holds a NUL");
  return value;
}

pose_t to_lcm(const Pose& pose) {
  pose_t message{};
  std::ranges::copy(pose.position, message.position);
  std::ranges::copy(pose.orientation, message.orientation);
  std::ranges::copy(pose.covariance, message.covariance);
  return message;
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

attribute_t to_lcm(const AttributeReport& report) {
  attribute_t message{};
  message.name = text(report.name);
  if (const auto* scalar = std::get_if<ScalarReport>(&report.value)) {
    message.kind = attribute_t::SCALAR;
    message.mean = scalar->mean;
    message.variance = scalar->variance;
    return message;
  }
  message.kind = attribute_t::SYMBOLS;
  for (const auto& [symbol, probability] : std::get<SymbolReport>(report.value).probabilities) {
    message.symbols.push_back(text(symbol));
    message.probabilities.push_back(probability);
  }
  message.num_symbols = static_cast<std::int32_t>(message.symbols.size());
  return message;
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
  message.object = text(detection.object);
  for (const AttributeReport& report : detection.attributes) {
    message.attributes.push_back(to_lcm(report));
  }
  message.num_attributes = static_cast<std::int32_t>(message.attributes.size());
  return message;
}

}  // namespace

std::vector<std::uint8_t> encode(const Frame& frame, std::int64_t seq) {
  frame_t message{};
  message.utime = frame.utime;
  message.seq = seq;
  message.robot = text(frame.robot);
  message.sensor = text(frame.sensor);
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
  return encode_message(message);
}

std::vector<std::uint8_t> canonical_bytes(const Frame& frame) { return encode(frame, 0); }

}  // namespace anchord
