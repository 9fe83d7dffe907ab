#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/time.h"

namespace anchord {

/// A frame as it was reported: all that one sensor saw at one instant, before anything of it has
/// been checked against a configuration. Both encodings (LCM and JSON) become this. Lengths in
/// metres, angles in radians. Sensor axes: x forward, y left, z up.

/// The sensor in the map frame.
struct Pose {
  std::array<double, 3> position{};               ///< of the sensor's origin, map frame
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< quaternion w, x, y, z: map from sensor
  std::array<double, 36> covariance{};            ///< row-major over map position and small
                                                  ///< rotations about the map's axes; zeros: exact
  bool operator==(const Pose&) const = default;
};

/// What the sensor could see, in the sensor frame (map frame for a frame without pose).
struct View {
  enum class Type { kNone = 0, kWorld = 1, kSector = 2, kFrustum = 3, kPolygon = 4 };
  Type type = Type::kNone;
  std::array<double, 2> range{};    ///< sector, frustum: least and most Euclidean range
  std::array<double, 2> bearing{};  ///< sector: from the first counter-clockwise to the second
  std::array<double, 2> elevation{-1.5707963267948966, 1.5707963267948966};  ///< sector
  double hfov = 0, vfov = 0;                  ///< frustum: full opening angles about +x
  std::vector<std::array<double, 2>> points;  ///< polygon, unbounded in z
  bool operator==(const View&) const = default;
};

/// A measured position, sensor frame.
struct CartesianMeasurement {
  std::vector<double> position;    ///< 2 or 3 numbers, as the world has dimensions
  std::vector<double> covariance;  ///< row-major, 4 or 9 numbers; empty: the sensor's noise holds
  bool operator==(const CartesianMeasurement&) const = default;
};

/// A measured direction and distance, sensor frame.
struct PolarMeasurement {
  double range = 0, bearing = 0, elevation = 0;
  std::vector<double> variance;  ///< of range, bearing, elevation; empty: the sensor's noise holds
  bool operator==(const PolarMeasurement&) const = default;
};

/// A distribution over symbols, as reported: it may name only some of them.
struct SymbolReport {
  std::vector<std::pair<std::string, double>> probabilities;
  bool operator==(const SymbolReport&) const = default;
};

/// A measured scalar.
struct ScalarReport {
  double mean = 0, variance = 0;
  bool operator==(const ScalarReport&) const = default;
};

struct AttributeReport {
  std::string name;
  std::variant<SymbolReport, ScalarReport> value;
  bool operator==(const AttributeReport&) const = default;
};

/// One measured object.
struct Detection {
  std::variant<CartesianMeasurement, PolarMeasurement> measurement;
  std::optional<double> score;  ///< calibrated probability that this is no clutter
  std::optional<double> yaw;    ///< heading of the object about the sensor's z, sensor frame
  std::string object;           ///< id of the anchor that a verification asked for; else empty
  std::vector<AttributeReport> attributes;
  bool operator==(const Detection&) const = default;
};

struct Frame {
  Utime utime = 0;
  std::string robot;  ///< who reports; empty for the only one. A sensor is (robot, sensor).
  std::string sensor;
  std::optional<Pose> pose;  ///< without it everything is in the map frame, exactly placed
  std::optional<View> view;  ///< without it the sensor's configured view holds
  std::vector<Detection> detections;
  bool operator==(const Frame&) const = default;
};

/// Most detections that a frame may have; a frame with more is refused.
inline constexpr std::size_t kMaxDetections = 10'000;

}  // namespace anchord
