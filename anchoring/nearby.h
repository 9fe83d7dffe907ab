#pragma once

#include <utility>

#include "anchoring/leaf.h"
#include "core/scratch.h"

namespace anchord {

/// The detections of one frame, for asking which of them may lie in a leaf's gates.
class Nearby {
 public:
  Nearby(const MapFrame& frame, const Background& background);

  /// The detections that log_likelihood() need be asked for, ascending: all whose x lies within
  /// the gate of a behaviour model of a predicted leaf, and all that name an object. Valid until
  /// the next call.
  const ScratchVector<int>& to(const Leaf& leaf);

 private:
  const Background& background_;
  ScratchVector<std::pair<double, int>> by_x_;  // position and number, ascending
  ScratchVector<int> naming_, all_, found_;
  double widest_ = 0;  // variance of a detection along x, the largest, m^2
};

}  // namespace anchord
