#include "lcmtypes/wire_check.h"

#include <anchord/frame_t.hpp>
#include <anchord/query_t.hpp>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "core/frame.h"
#include "lcmtypes/field.h"
#include "lcmtypes/names.h"

namespace anchord {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kNumber = 8;     // bytes of a double or int64_t
constexpr std::size_t kLeastText = 5;  // length and NUL
constexpr std::size_t kLeastAttribute = kLeastText + 1 + 4 + 2 * kNumber;
constexpr std::size_t kLeastDetection = 1 + 3 * kNumber + 4 + 2 * (1 + kNumber) + kLeastText + 4;

/// Walks over a message. Every step returns whether it went well; the first that does not leaves
/// its error, and the walk ends there.
class Walk {
 public:
  explicit Walk(Bytes bytes) : rest_(bytes) {
    if (bytes.size() > kMaxMessageBytes) {
      error_ = Error{ErrorCode::kTooLarge, "", "the message has more than 8 MiB"};
      rest_ = {};
    }
  }

  Status outcome() const { return error_ ? Status(*error_) : Status(Done{}); }

  bool fingerprint(std::int64_t expected) {
    std::int64_t found = 0;
    if (!integer(Field(), 8, found)) return false;
    return found == expected ||
           refuse(Field(), "the fingerprint is not that of this message type and version");
  }

  bool numbers(const Field& field, std::size_t count) { return skip(field, count * kNumber); }

  bool flag(const Field& field) {
    std::int64_t value = 0;
    if (!integer(field, 1, value)) return false;
    return value == 0 || value == 1 || refuse(field, "must be 0 or 1");
  }

  bool enumerator(const Field& field, int least, int most, int& value) {
    std::int64_t found = 0;
    if (!integer(field, 1, found)) return false;
    if (found < least || found > most) return refuse(field, "is not one of the type's constants");
    value = static_cast<int>(found);
    return true;
  }

  /// A count of things that take at least `bytes_each`.
  bool count(const Field& field, std::size_t most, std::size_t bytes_each, std::size_t& value) {
    std::int64_t found = 0;
    if (!integer(field, 4, found)) return false;
    if (found < 0) return refuse(field, "must not be negative");
    value = static_cast<std::size_t>(found);
    if (value > most) return refuse(field, "must be at most " + std::to_string(most));
    return value * bytes_each <= rest_.size() || refuse(field, "says more than the message holds");
  }

  bool count_of(const Field& field, std::initializer_list<std::size_t> allowed,
                std::size_t& value) {
    if (!count(field, kMaxMessageBytes, kNumber, value)) return false;
    std::string list;
    for (const std::size_t one : allowed) {
      if (value == one) return true;
      list += (list.empty() ? "" : " or ") + std::to_string(one);
    }
    return refuse(field, "must be " + list);
  }

  bool text(const Field& field, std::size_t max_bytes, bool may_be_empty = true) {
    std::int64_t length = 0;  // counts the NUL
    if (!integer(field, 4, length)) return false;
    if (length < 1) return refuse(field, "has a length below 1");
    const Bytes start = rest_;
    if (!skip(field, static_cast<std::size_t>(length))) return false;
    const std::string_view value(reinterpret_cast<const char*>(start.data()),
                                 static_cast<std::size_t>(length) - 1);
    if (start[value.size()] != 0) return refuse(field, "does not end with NUL");
    if (value.empty() && !may_be_empty) return refuse(field, "must not be empty");
    const char* fault = text_fault(value, max_bytes);
    return !fault || refuse(field, fault);
  }

  bool end() { return rest_.empty() || refuse(Field(), "bytes follow the end of the message"); }

 private:
  bool refuse(const Field& field, std::string message) {
    if (!error_) error_ = invalid(field.text(), std::move(message));
    return false;
  }

  bool skip(const Field& field, std::size_t bytes) {
    if (bytes > rest_.size()) return refuse(field, "the message ends before it");
    rest_ = rest_.subspan(bytes);
    return true;
  }

  /// A signed big-endian integer.
  bool integer(const Field& field, std::size_t bytes, std::int64_t& value) {
    const Bytes start = rest_;
    if (!skip(field, bytes)) return false;
    std::uint64_t bits = start[0] >= 0x80 ? ~std::uint64_t{0} : 0;
    for (std::size_t i = 0; i < bytes; ++i) bits = bits << 8 | start[i];
    value = static_cast<std::int64_t>(bits);
    return true;
  }

  Bytes rest_;
  std::optional<Error> error_;
};

bool walk_pose(Walk& walk, const Field& pose) {
  return walk.numbers(pose.member("position"), 3) && walk.numbers(pose.member("orientation"), 4) &&
         walk.numbers(pose.member("covariance"), 36);
}

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
  return walk.count(view.member("num_points"), most_points, 2 * kNumber, points) &&
         walk.numbers(view.member("points"), 2 * points);
}

bool walk_attribute(Walk& walk, const Field& attribute) {
  int kind = 0;
  std::size_t symbols = 0;
  if (!walk.text(attribute.member("name"), kMaxNameBytes, false) ||
      !walk.enumerator(attribute.member("kind"), attribute_t::SYMBOLS, attribute_t::SCALAR, kind)) {
    return false;
  }
  const std::size_t most_symbols = kind == attribute_t::SYMBOLS ? kMaxSymbols : 0;
  if (!walk.count(attribute.member("num_symbols"), most_symbols, kLeastText + kNumber, symbols)) {
    return false;
  }
  const Field names = attribute.member("symbols");
  for (std::size_t i = 0; i < symbols; ++i) {
    if (!walk.text(names.element(i), kMaxNameBytes, false)) return false;
  }
  return walk.numbers(attribute.member("probabilities"), symbols) &&
         walk.numbers(attribute.member("mean"), 1) && walk.numbers(attribute.member("variance"), 1);
}

bool walk_detection(Walk& walk, const Field& detection) {
  int kind = 0;
  std::size_t covariance = 0, attributes = 0;
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
      !walk.text(detection.member("object"), kMaxNameBytes) ||
      !walk.count(detection.member("num_attributes"), kMaxAttributes, kLeastAttribute,
                  attributes)) {
    return false;
  }
  const Field list = detection.member("attributes");
  for (std::size_t i = 0; i < attributes; ++i) {
    if (!walk_attribute(walk, list.element(i))) return false;
  }
  return true;
}

bool walk_frame(Walk& walk, const Field& frame) {
  std::size_t detections = 0;
  if (!walk.numbers(frame.member("utime"), 1) || !walk.numbers(frame.member("seq"), 1) ||
      !walk.text(frame.member("robot"), kMaxNameBytes) ||
      !walk.text(frame.member("sensor"), kMaxNameBytes, false) ||
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

bool walk_query(Walk& walk, const Field& query) {
  return walk.numbers(query.member("id"), 1) && walk.text(query.member("target"), kMaxTargetBytes);
}

}  // namespace

Status check_frame(Bytes bytes) {
  Walk walk(bytes);
  walk.fingerprint(frame_t::getHash()) && walk_frame(walk, Field()) && walk.end();
  return walk.outcome();
}

Status check_query(Bytes bytes) {
  Walk walk(bytes);
  walk.fingerprint(query_t::getHash()) && walk_query(walk, Field()) && walk.end();
  return walk.outcome();
}

}  // namespace anchord
