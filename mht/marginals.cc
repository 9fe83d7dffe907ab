#include "mht/marginals.h"

#include <algorithm>
#include <cmath>

namespace anchord {
namespace {

/// Messages have settled when none changes by more than this share of itself. The iteration is a
/// contraction; loops of near certain pairings take longest.
constexpr double kSettled = 1e-3;
constexpr int kMostRounds = 100;
/// A pairing that is less probable takes part in no exchange that counts.
constexpr double kLikely = 0.01;

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

void count_exchanges(ScratchVector<Pairing>& pairings, int tracks, int detections) {
  ScratchVector<std::size_t> first(tracks + 1, 0);  // per track, in `pairings`
  for (const Pairing& p : pairings) ++first[p.track + 1];
  for (int t = 0; t < tracks; ++t) first[t + 1] += first[t];
  ScratchVector<SmallScratchVector<std::size_t, 4>> likely(detections);
  for (std::size_t e = 0; e < pairings.size(); ++e)
    if (pairings[e].probability >= kLikely) likely[pairings[e].detection].push_back(e);
  ScratchVector<double> raised(pairings.size(), 0.0);
  for (const auto& of_detection : likely)
    for (const std::size_t own : of_detection) {
      const Pairing& one = pairings[own];
      for (std::size_t e = first[one.track]; e < first[one.track + 1]; ++e)
        for (const std::size_t taken : likely[pairings[e].detection]) {
          const Pairing& other = pairings[taken];
          if (other.track == one.track) continue;
          std::size_t back = first[other.track];
          while (back < first[other.track + 1] && pairings[back].detection != one.detection) ++back;
          if (back == first[other.track + 1]) continue;
          const double odds =
              pairings[e].weight / one.weight * (pairings[back].weight / other.weight);
          raised[e] = std::max(raised[e], one.probability * other.probability * odds / (1 + odds));
        }
    }
  for (std::size_t e = 0; e < pairings.size(); ++e)
    pairings[e].probability = std::max(pairings[e].probability, raised[e]);
}

}  // namespace anchord
