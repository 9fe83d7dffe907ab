#include "lcmtypes/checked_decode.h"

#include <algorithm>
#include <anchord/frame_t.hpp>
#include <anchord/query_t.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "lcmtypes/field.h"
#include "lcmtypes/names.h"
#include "lcmtypes/wire_check.h"

namespace anchord {
namespace {

/// lcm-gen's decoding of bytes that have passed their check; false if it disagrees with the check.
template <typename Message>
bool decode(std::span<const std::uint8_t> bytes, Message& message) {
  const int size = static_cast<int>(bytes.size());  // at most kMaxMessageBytes
  return message.decode(bytes.data(), 0, size) == size;
}

Error disagreement() { return invalid("", "the message does not decode to its own size"); }

Pose from_lcm(const pose_t& message) {
  Pose pose;
  std::ranges::copy(message.position, pose.position.begin());
  std::ranges::copy(message.orientation, pose.orientation.begin());
  std::ranges::copy(message.covariance, pose.covariance.begin());
  return pose;
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
  for (const attribute_t& attribute : message.attributes) {
    detection.attributes.push_back(from_lcm(attribute));
  }
  return detection;
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

Status check_repeats(const detection_t& detection, const Field& field) {
  std::vector<std::string_view> names;
  const Field attributes = field.member("attributes");
  for (std::size_t i = 0; i < detection.attributes.size(); ++i) {
    const attribute_t& attribute = detection.attributes[i];
    names.push_back(attribute.name);
    const int symbol = first_repeated({attribute.symbols.begin(), attribute.symbols.end()});
    if (symbol >= 0) {
      const Field where = attributes.element(i);
      const Field symbols = where.member("symbols");
      return invalid(symbols.element(symbol).text(), "this symbol is there already");
    }
  }
  const int repeated = first_repeated(names);
  if (repeated < 0) return Done{};
  return invalid(attributes.element(repeated).text(), "this attribute is there already");
}

}  // namespace

Result<FrameMessage> decode_frame(std::span<const std::uint8_t> bytes) {
  const Status checked = check_frame(bytes);
  if (!checked) return checked.error();
  frame_t message;
  if (!decode(bytes, message)) return disagreement();
  const Field root;
  const Field detections = root.member("detections");
  for (std::size_t i = 0; i < message.detections.size(); ++i) {
    const Status unique = check_repeats(message.detections[i], detections.element(i));
    if (!unique) return unique.error();
  }
  return FrameMessage{from_lcm(message), message.seq};
}

Result<Query> decode_query(std::span<const std::uint8_t> bytes) {
  const Status checked = check_query(bytes);
  if (!checked) return checked.error();
  query_t message;
  if (!decode(bytes, message)) return disagreement();
  return Query{message.id, std::move(message.target)};
}

}  // namespace anchord
