#pragma once

#include "mht/assignment.h"

namespace anchord {

/// What it costs to change an optimal assignment: for each pair that it does not have, and for
/// each detection that it gives a leaf, the least that an assignment loses which has the pair, or
/// gives it none.
///
/// A change is a cycle of detections, each of which takes the leaf of the next; leaves and
/// detections that are free stand in it as "nobody". A pair's slack alone bounds its loss from
/// below, but most slacks of an optimum are about 0, whatever the pair costs; the way back from
/// the one who loses its leaf (by Dijkstra, over slacks) makes the bound exact.
class ChangeLosses {
 public:
  /// Losses above `reach` are given as infinite.
  ChangeLosses(const PairGains& gains, const Assignment& best, double reach);

  /// Of the i-th pair of detection z, in its row; 0 for its choice.
  double of(int z, std::size_t i) const { return of_pair_[first_[z] + i]; }
  /// Of giving z none; 0 for its choice.
  double of_none(int z) const { return of_none_[z]; }
  double reach() const { return reach_; }
  /// How many are within reach, the choices themselves left out.
  int within_reach() const { return within_; }

 private:
  ScratchVector<std::size_t> first_;  // per detection
  ScratchVector<double> of_pair_, of_none_;
  double reach_;
  int within_ = 0;
};

}  // namespace anchord
