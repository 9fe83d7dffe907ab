#pragma once

#include "core/scratch.h"

namespace anchord {

/// One frame's association within a cluster, in log-weights. Leaves and detections are numbers.
struct AssociationProblem {
  /// A hypothesis before the frame, its leaves taken as if each gave nothing and every detection
  /// as new or clutter.
  struct Parent {
    double log_weight = 0;
    ScratchVector<int> leaves;  ///< indices into `gains`
  };
  /// What it is worth to give a detection to a leaf instead: ln (r g / (1 - r q)) - ln (kappa + e).
  struct Gain {
    int detection;
    double log_gain;
  };
  using Gains = SmallScratchVector<Gain, 4>;

  int detections = 0;
  ScratchVector<Gains> gains;  ///< per leaf: of those that it may be given, ascending
  ScratchVector<Parent> parents;
};

/// One hypothesis after the frame.
struct Association {
  static constexpr int kNone = -1;
  int parent = 0;
  double log_weight = 0;
  SmallScratchVector<int, 8> leaf_of;  ///< per detection one of the parent's or kNone
};

}  // namespace anchord
