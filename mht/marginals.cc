#include "mht/marginals.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace anchord {
namespace {

/// Messages have settled when none changes by more than this share of itself. The iteration is a
/// contraction; loops of near certain pairings take longest.
constexpr double kSettled = 1e-3;
constexpr int kMostRounds = 100;
/// A pairing that is less probable takes part in no exchange that counts.
constexpr double kLikely = 0.01;

/// What a detection and a track tell each other of their pairing.
struct Message {
  int track, detection;
  bool both_ways;  // else only the detection has news
  double weight, to_track, to_detection;
};

/// The messages between tracks and detections that have several pairings.
class Messages {
 public:
  Messages(int tracks, int detections)
      : tracks_(tracks),
        part_(tracks + detections),
        of_track_(tracks),
        of_detection_(detections),
        to_track_(tracks, 1.0),
        to_detection_(detections, 1.0) {
    std::iota(part_.begin(), part_.end(), 0);
  }

  void add(const Message& message) {
    messages_.push_back(message);
    const int a = find(message.track), b = find(tracks_ + message.detection);
    part_[std::max(a, b)] = std::min(a, b);
  }
  /// What never changes.
  void add_to_track(int track, double weight) { to_track_[track] += weight; }
  void add_to_detection(int detection, double weight) { to_detection_[detection] += weight; }

  /// What each track is told in the end, in the order of add(). What hangs together settles on its
  /// own: a loop of near certain pairings does not keep all others going.
  ScratchVector<double> settle() {
    ScratchVector<std::pair<int, int>> by_part;
    for (const Message& m : messages_)
      by_part.push_back({find(m.track), static_cast<int>(by_part.size())});
    std::sort(by_part.begin(), by_part.end());
    ScratchVector<Message> part;
    ScratchVector<double> told(messages_.size());
    for (std::size_t i = 0; i < by_part.size();) {
      part.clear();
      const std::size_t first = i;
      for (; i < by_part.size() && by_part[i].first == by_part[first].first; ++i)
        part.push_back(messages_[by_part[i].second]);
      for (int round = 0; round < kMostRounds && !tell(part); ++round) {
      }
      for (std::size_t k = first; k < i; ++k) told[by_part[k].second] = part[k - first].to_track;
    }
    return told;
  }

 private:
  int find(int i) {
    while (part_[i] != i) i = part_[i] = part_[part_[i]];
    return i;
  }

  /// One round. Returns whether next to nothing has changed.
  bool tell(ScratchVector<Message>& part) {
    for (const Message& m : part) {
      of_track_[m.track] = to_track_[m.track];
      of_detection_[m.detection] = to_detection_[m.detection];
    }
    for (const Message& m : part)
      if (m.both_ways) of_track_[m.track] += m.weight * m.to_track;
    for (Message& m : part) {
      if (!m.both_ways) continue;
      // Without m itself; rounding must not make it less than "gives nothing".
      m.to_detection = m.weight / std::max(of_track_[m.track] - m.weight * m.to_track, 1.0);
      of_detection_[m.detection] += m.to_detection;
    }
    bool settled = true;
    for (Message& m : part) {
      const double next = 1 / std::max(of_detection_[m.detection] - m.to_detection, 1.0);
      settled = settled && std::abs(next - m.to_track) <= kSettled * m.to_track;
      m.to_track = next;
    }
    return settled;
  }

  int tracks_;
  ScratchVector<int> part_;  // of a track, and behind them of a detection: those that hang together
  ScratchVector<Message> messages_;
  ScratchVector<double> of_track_, of_detection_;  // sums of a round
  ScratchVector<double> to_track_, to_detection_;  // of that what never changes
};

}  // namespace

void estimate_probabilities(ScratchVector<Pairing>& pairings, int tracks, int detections) {
  ScratchVector<int> pairings_of_track(tracks, 0), pairings_of_detection(detections, 0);
  for (const Pairing& p : pairings) {
    ++pairings_of_track[p.track];
    ++pairings_of_detection[p.detection];
  }
  // What the only pairing of a detection is told is always 1, and what the only pairing of a track
  // tells is always its weight: neither is told again in each round.
  Messages messages(tracks, detections);
  for (const auto& [track, detection, weight, probability] : pairings) {
    const bool only_of_track = pairings_of_track[track] == 1;
    if (only_of_track) messages.add_to_detection(detection, weight);
    if (pairings_of_detection[detection] == 1)
      messages.add_to_track(track, weight);
    else
      messages.add({track, detection, !only_of_track, weight, 1, weight});
  }
  const ScratchVector<double> told = messages.settle();
  ScratchVector<double> of_track(tracks, 1.0);
  auto next = told.begin();
  for (Pairing& p : pairings) {
    p.probability = p.weight * (pairings_of_detection[p.detection] == 1 ? 1.0 : *next++);
    of_track[p.track] += p.probability;
  }
  for (Pairing& p : pairings) p.probability /= of_track[p.track];
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
