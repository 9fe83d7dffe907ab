#include "lcmtypes/frame_walk.h"

#include <anchord/frame_t.hpp>

#include "core/frame.h"
#include "lcmtypes/names.h"

namespace anchord {
namespace {

constexpr std::size_t kLeastAttribute = kLeastTextBytes + 1 + 4 + 2 * kNumberBytes;
constexpr std::size_t kLeastDetection =
    1 + 3 * kNumberBytes + 4 + 2 * (1 + kNumberBytes) + kLeastTextBytes + 4;

bool walk_view(Walk& walk, const Field& view) {
  int type = 0;
  if (!walk.enumerator(view.member("type"), view_t::CONFIGURED, view_t::POLYGON, type) ||
      !walk.numbers(view.member("range"), 2) || !walk.numbers(view.member("bearing"), 2) ||
      !walk.numbers(view.member("elevation"), 2) || !walk.numbers(view.member("hfov"), 1) ||
      !walk.numbers(view.member("vfov"), 1)) {
    return false;
  }
  const std::size_t most_points = type == view_t::POLYGON ? kMaxPolygonPoints : 0;
  std::size_t points = 0;
  return walk.count(view.member("num_points"), most_points, 2 * kNumberBytes, points) &&
         walk.numbers(view.member("points"), 2 * points);
}

bool walk_attribute(Walk& walk, const Field& attribute) {
  int kind = 0;
  std::size_t symbols = 0;
  if (!walk.name(attribute.member("name")) ||
      !walk.enumerator(attribute.member("kind"), attribute_t::SYMBOLS, attribute_t::SCALAR, kind)) {
    return false;
  }
  const std::size_t most_symbols = kind == attribute_t::SYMBOLS ? kMaxSymbols : 0;
  if (!walk.count(attribute.member("num_symbols"), most_symbols, kLeastTextBytes + kNumberBytes,
                  symbols)) {
    return false;
  }
  const Field names = attribute.member("symbols");
  for (std::size_t i = 0; i < symbols; ++i) {
    if (!walk.name(names.element(i))) return false;
  }
  return walk.numbers(attribute.member("probabilities"), symbols) &&
         walk.numbers(attribute.member("mean"), 1) && walk.numbers(attribute.member("variance"), 1);
}

bool walk_detection(Walk& walk, const Field& detection) {
  int kind = 0;
  std::size_t covariance = 0;
  if (!walk.enumerator(detection.member("kind"), detection_t::POSITION, detection_t::POLAR, kind) ||
      !walk.numbers(detection.member("measurement"), 3)) {
    return false;
  }
  const Field num_covariance = detection.member("num_covariance");
  const bool counted = kind == detection_t::POSITION
                           ? walk.count_of(num_covariance, {0, 4, 9}, covariance)
                           : walk.count_of(num_covariance, {0, 3}, covariance);
  if (!counted || !walk.numbers(detection.member("covariance"), covariance) ||
      !walk.flag(detection.member("has_score")) || !walk.numbers(detection.member("score"), 1) ||
      !walk.flag(detection.member("has_yaw")) || !walk.numbers(detection.member("yaw"), 1) ||
      !walk.text(detection.member("object"))) {
    return false;
  }
  return walk_attributes(walk, detection.member("num_attributes"), detection.member("attributes"));
}

}  // namespace

bool walk_pose(Walk& walk, const Field& pose) {
  return walk.numbers(pose.member("position"), 3) && walk.numbers(pose.member("orientation"), 4) &&
         walk.numbers(pose.member("covariance"), 36);
}

bool walk_attributes(Walk& walk, const Field& count, const Field& list) {
  std::size_t attributes = 0;
  if (!walk.count(count, kMaxAttributes, kLeastAttribute, attributes)) return false;
  for (std::size_t i = 0; i < attributes; ++i) {
    if (!walk_attribute(walk, list.element(i))) return false;
  }
  return true;
}

bool walk_frame(Walk& walk, const Field& frame, bool used) {
  const Field sensor = frame.member("sensor");
  std::size_t detections = 0;
  if (!walk.numbers(frame.member("utime"), 1) || !walk.numbers(frame.member("seq"), 1) ||
      !walk.text(frame.member("robot")) || !(used ? walk.name(sensor) : walk.text(sensor)) ||
      !walk.flag(frame.member("has_pose")) || !walk_pose(walk, frame.member("pose")) ||
      !walk_view(walk, frame.member("view")) ||
      !walk.count(frame.member("num_detections"), kMaxDetections, kLeastDetection, detections)) {
    return false;
  }
  const Field list = frame.member("detections");
  for (std::size_t i = 0; i < detections; ++i) {
    if (!walk_detection(walk, list.element(i))) return false;
  }
  return true;
}

}  // namespace anchord
