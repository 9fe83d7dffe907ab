#pragma once

#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "anchoring/background.h"
#include "anchoring/score_trace.h"
#include "core/frame.h"
#include "core/result.h"
#include "geometry/gaussian.h"
#include "geometry/view.h"

namespace anchord {

/// What a detection says about one attribute other than its class.
struct AttributeEvidence {
  int attribute = 0;              ///< index into Knowledge::attributes
  std::vector<double> ratio;      ///< categorical: per symbol m(s) / pi(s), likelihood over prior
  double mean = 0, variance = 0;  ///< scalar
};

/// A detection, placed in the map and resolved against the knowledge.
struct MapDetection {
  Gaussian position;
  bool has_class = false;
  /// l(z|c) per class; 1 if no class was reported. A phantom's with what the score says of a thing
  /// that is reported for the first time.
  std::vector<double> class_ratio;
  /// p_D,c at its distance, per class.
  boost::container::small_vector<double, 8> p_detected;
  int label = -1;    ///< the class that is reported as the most probable one; -1: none
  double range = 0;  ///< m, from the sensor; 0 in a frame without a pose
  std::optional<double> log_odds;      ///< of the score, as the sensor's calibration has it
  std::optional<ScoreEvidence> score;  ///< where there are phantoms
  std::vector<AttributeEvidence> attributes;
  double log_clutter = 0;     ///< ln kappa(z)
  std::optional<double> yaw;  ///< map frame
  std::string object;         ///< the anchor that it names, or empty
  /// What of it lies in each place where objects are looked for, see Background::searched().
  std::vector<std::pair<const Footprint*, MeasuredIn>> in_places;

  /// What of it lies in a place: as taken down, or worked out.
  MeasuredIn in(const Footprint& place) const;
};

/// A frame, checked and placed in the map: what the engine folds.
struct MapFrame {
  Utime utime = 0;
  std::string robot, sensor_name;
  const Sensor* sensor = nullptr;  ///< in the Background
  std::uint32_t viewer = 0;  ///< a number for that sensor of that robot, the same in each frame
  MapView view;
  std::optional<Eigen::Vector3d> eye;  ///< where the sensor was, if it said so
  std::vector<MapDetection> detections;
  std::optional<std::uint64_t> work;  ///< bound on what folding it may take; see Effort
};

/// Checks everything about a frame that does not depend on the frames before it, and places it in
/// the map. Refuses what cannot be believed: numbers that are not finite, covariances that are not
/// symmetric positive definite, probabilities outside 0..1 or that sum to nothing or to more than
/// 1.001, unknown attributes and symbols, stamps outside 2000 to 2100, too many detections. The
/// error's field is a path in the frame: `detections[3].attributes.color.blau`.
Result<MapFrame> place_in_map(const Frame& frame, const Background& background);

}  // namespace anchord
