#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/anchoring/camera.h"
#include "knowledge/knowledge.h"

namespace anchord::experiment {

/// What the blob detector says of a blob's size and shape.
enum class BlobReport {
  kSymbols,  ///< predicate symbols by table 2.2, each with probability 0.8
  kNumbers   ///< the measured diagonal and ratio
};

/// A colored blob as the camera sees it: width and height in m.
struct Blob {
  Eigen::Vector2d position;
  double width = 0, height = 0;
  std::string color;

  double diagonal() const;
  double ratio() const { return height / width; }
};

/// Table 2.2: `small`, `medium` or `large`; `rectangle` or `square`.
std::string size_symbol(double diagonal);
std::string shape_symbol(double ratio);

/// The objects of figure 2.2, but that the cup takes the red box's place.
enum BoxesObject { kLeftBox, kSmallBox, kRedObject, kRightBox, kBoxesObjects };

/// One frame of the table with tea boxes (thesis section 2.6.1).
struct BoxesShot {
  double time = 0;        ///< s
  std::string part;       ///< `three`, `hidden`, `cup`, `added`, `touching`, `parted`
  bool one_blob = false;  ///< the two green boxes give one blob
  std::array<std::optional<Eigen::Vector2d>, kBoxesObjects> truth;
  Frame frame;
};

/// Three objects, one of which is moved about, for 8 s; all hidden for 4 s, in which the red box is
/// taken away and a red cup put elsewhere; then that for 6 s; a second green medium box is added,
/// and pushed to the first: for 10 s they touch, and the detector goes to and fro between two blobs
/// and one, after 1 s in each on average; then they part again. 10 Hz.
std::vector<BoxesShot> simulate_boxes(BlobReport report, Dice& dice);

struct BoxesBelief {
  int shown = 0;         ///< objects in the best world
  double one_large = 0;  ///< P(there is a large green object)
  /// The birth of the anchor that stands where each object is in the best world, or 0.
  std::array<std::uint64_t, kBoxesObjects> names{};
};

std::vector<BoxesBelief> watch_boxes(const Knowledge& knowledge,
                                     const std::vector<BoxesShot>& shots);

}  // namespace anchord::experiment
