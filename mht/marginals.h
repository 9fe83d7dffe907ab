#pragma once

#include "core/scratch.h"

namespace anchord {

/// That a detection may come from a track.
struct Pairing {
  int track = 0, detection = 0;
  /// What it is worth, over the track giving nothing and the detection coming from no track.
  double weight = 0;
  double probability = 0;  ///< see estimate_probabilities()
};

/// About how probable each pairing is, if each detection comes from at most one track and each
/// track gives at most one detection: loopy belief propagation, exact where the graph of pairings
/// has no loop. `tracks` and `detections`: one more than the largest of their numbers.
///
/// Williams and Lau, "Approximate evaluation of marginal association probabilities with belief
/// propagation", IEEE Trans. AES 50(4), 2014.
void estimate_probabilities(ScratchVector<Pairing>& pairings, int tracks, int detections);

/// Raises estimated probabilities to what two tracks that may exchange their detections give them.
/// Where both are nearly sure to give one of the two, belief propagation is all for the more
/// probable way round, be the other one nearly as probable: the Bethe permanent of two by two is
/// the larger product (Vontobel, IEEE Trans. IT 59(3), 2013). `pairings`: in order of their tracks.
void count_exchanges(ScratchVector<Pairing>& pairings, int tracks, int detections);

}  // namespace anchord
