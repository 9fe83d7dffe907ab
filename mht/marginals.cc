#include "mht/marginals.h"

#include <algorithm>
#include <cmath>

namespace anchord {
namespace {

/// Messages have settled when none changes by more than this share of itself. The iteration is a
/// contraction; loops of near certain pairings take longest.
constexpr double kSettled = 1e-3;
constexpr int kMostRounds = 100;

}  // namespace

void estimate_probabilities(ScratchVector<Pairing>& pairings, int tracks, int detections) {
  ScratchVector<double> message(pairings.size(), 1);  // detection to track
  ScratchVector<double> of_track(tracks), of_detection(detections);
  ScratchVector<double> to_detection(pairings.size());
  double change = 1;
  for (int round = 0; round < kMostRounds && change > kSettled; ++round) {
    std::fill(of_track.begin(), of_track.end(), 1.0);
    for (std::size_t e = 0; e < pairings.size(); ++e)
      of_track[pairings[e].track] += pairings[e].weight * message[e];
    std::fill(of_detection.begin(), of_detection.end(), 1.0);
    for (std::size_t e = 0; e < pairings.size(); ++e) {
      const Pairing& p = pairings[e];
      // Without p itself; rounding must not make it less than "gives nothing".
      const double others = std::max(of_track[p.track] - p.weight * message[e], 1.0);
      to_detection[e] = p.weight / others;
      of_detection[p.detection] += to_detection[e];
    }
    change = 0;
    for (std::size_t e = 0; e < pairings.size(); ++e) {
      const double others = std::max(of_detection[pairings[e].detection] - to_detection[e], 1.0);
      change = std::max(change, std::abs(1 / others - message[e]) / message[e]);
      message[e] = 1 / others;
    }
  }
  std::fill(of_track.begin(), of_track.end(), 1.0);
  for (std::size_t e = 0; e < pairings.size(); ++e)
    of_track[pairings[e].track] += pairings[e].weight * message[e];
  for (std::size_t e = 0; e < pairings.size(); ++e)
    pairings[e].probability = pairings[e].weight * message[e] / of_track[pairings[e].track];
}

}  // namespace anchord
