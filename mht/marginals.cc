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
  ScratchVector<int> pairings_of_track(tracks, 0), pairings_of_detection(detections, 0);
  for (const Pairing& p : pairings) {
    ++pairings_of_track[p.track];
    ++pairings_of_detection[p.detection];
  }
  // What the only pairing of a detection is told is always 1, and what the only pairing of a track
  // tells is always its weight: neither is told again in each round.
  struct Message {
    int track, detection;
    double weight, to_track, to_detection;
  };
  ScratchVector<Message> both_ways, to_track;
  ScratchVector<double> settled_of_track(tracks, 1.0), settled_of_detection(detections, 1.0);
  for (const auto& [track, detection, weight, probability] : pairings) {
    const bool only_of_track = pairings_of_track[track] == 1;
    if (pairings_of_detection[detection] == 1)
      settled_of_track[track] += weight;
    else
      (only_of_track ? to_track : both_ways).push_back({track, detection, weight, 1, weight});
    if (only_of_track) settled_of_detection[detection] += weight;
  }
  ScratchVector<double> of_track, of_detection;
  bool settled = false;
  const auto answer = [&](Message& m) {
    const double others = std::max(of_detection[m.detection] - m.to_detection, 1.0);
    const double next = 1 / others;
    settled = settled && std::abs(next - m.to_track) <= kSettled * m.to_track;
    m.to_track = next;
  };
  for (int round = 0; round < kMostRounds && !settled; ++round) {
    of_track = settled_of_track;
    for (const Message& m : both_ways) of_track[m.track] += m.weight * m.to_track;
    of_detection = settled_of_detection;
    for (Message& m : both_ways) {
      // Without m itself; rounding must not make it less than "gives nothing".
      m.to_detection = m.weight / std::max(of_track[m.track] - m.weight * m.to_track, 1.0);
      of_detection[m.detection] += m.to_detection;
    }
    settled = true;
    for (Message& m : both_ways) answer(m);
    for (Message& m : to_track) answer(m);
  }
  of_track = settled_of_track;
  for (const Message& m : both_ways) of_track[m.track] += m.weight * m.to_track;
  for (const Message& m : to_track) of_track[m.track] += m.weight * m.to_track;
  auto next_of_both = both_ways.begin(), next_to_track = to_track.begin();
  for (Pairing& p : pairings) {
    double told = 1;
    if (pairings_of_detection[p.detection] > 1)
      told = (pairings_of_track[p.track] == 1 ? next_to_track++ : next_of_both++)->to_track;
    p.probability = p.weight * told / of_track[p.track];
  }
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
