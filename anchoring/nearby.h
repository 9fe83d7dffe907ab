#pragma once

#include "anchoring/leaf.h"
#include "core/scratch.h"

namespace anchord {

/// The detections of one frame, for asking which of them may lie in a leaf's gates.
class Nearby {
 public:
  Nearby(const MapFrame& frame, const Background& background);

  /// The detections that log_likelihood() need be asked for, ascending: all whose x and y lie
  /// within the gate of a behaviour model of a predicted leaf, and all that name an object. Valid
  /// until the next call.
  const ScratchVector<int>& to(const Leaf& leaf);

 private:
  struct Place {
    double x, y;
    int detection;
  };
  void take(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double variance_x,
            double variance_y);

  const Background& background_;
  ScratchVector<Place> by_x_;  // ascending
  ScratchVector<int> naming_, all_, found_;
  double widest_x_ = 0, widest_y_ = 0;  // variances of a detection, the largest, m^2
};

}  // namespace anchord
