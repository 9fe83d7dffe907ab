#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "knowledge/knowledge.h"

/// The belief by brute force: every association of every detection, with "new" and "clutter" as
/// separate worlds, and every departure of every object between two frames. It costs exponentially
/// much and shares no code with the engine; it is what the engine is checked against.
namespace anchord::enumeration {

/// An object is named by the detection that it was first seen in.
struct ObjectKey {
  std::size_t frame = 0, detection = 0;
  auto operator<=>(const ObjectKey&) const = default;
};

/// How a detection's `object` names an object here: "@frame.detection". A comparison puts the
/// engine's own id of that anchor in its place.
std::string reference(const ObjectKey& key);
/// Reads one; nothing for any other text.
std::optional<ObjectKey> parse_reference(const std::string& text);

struct EnumeratedObject {
  double p_exists = 0;  ///< now, and is no phantom; 0 leaves everything below at zero
  // Given that:
  Eigen::VectorXd mean;        ///< of its position, dims
  Eigen::MatrixXd covariance;  ///< of its position, dims x dims
  std::vector<double> classes;
  std::vector<std::vector<double>> models;  ///< [class][model]: it has that class's models, in it
  /// By attribute other than class: given also that it holds the attribute.
  struct Symbols {
    double p_held = 0;  ///< given that it exists
    std::vector<double> belief;
  };
  struct Scalar {
    double p_held = 0;
    double mean = 0, variance = 0;
  };
  std::map<int, Symbols> symbols;
  std::map<int, Scalar> scalars;
};

/// Where a detection came from; sums to 1.
struct Origin {
  std::map<ObjectKey, double> objects;  ///< first seen earlier
  double p_new = 0;                     ///< its first detection, departed since or not
  double p_clutter = 0;
};

struct EnumeratedBelief {
  std::size_t worlds = 0;
  double evidence = 0;  ///< the sum of the worlds' weights before they were normalised
  /// Detections of clutter and of undetected objects that all frames together led to expect.
  double expected_detections = 0;
  std::map<ObjectKey, EnumeratedObject> objects;  ///< one for every detection
  std::vector<std::vector<Origin>> origins;       ///< [frame][detection]
  std::vector<double> undetected;                 ///< expected number within the bounds, per class
};

/// The belief after the last frame. `frames` stand in the order of their utime. Supported: frames
/// without pose; Cartesian detections; views world, none and polygons of axis-parallel edges along
/// cell borders; places and bounds likewise; arrivals at places. Anything else aborts.
EnumeratedBelief enumerate(const Knowledge& knowledge, const std::vector<Frame>& frames);

}  // namespace anchord::enumeration
