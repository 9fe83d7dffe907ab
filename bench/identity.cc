#include "bench/identity.h"

#include <limits>

#include "mht/assignment.h"

namespace anchord::bench {
namespace {

/// Of an object without a track, m: more than any pairing can save.
constexpr double kUnpaired = 1e4;

}  // namespace

void IdentityCount::add(const std::vector<Eigen::Vector2d>& truth,
                        const std::vector<Track>& tracks) {
  const int n = static_cast<int>(truth.size()), m = static_cast<int>(tracks.size());
  paired_.resize(n, kNone);
  last_.resize(n, kNone);
  constexpr int kFree = -1;
  std::vector<int> track_of(n, kFree);
  std::vector<char> taken(m, 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m && paired_[i] != kNone; ++j)
      if (static_cast<std::int64_t>(tracks[j].id) == paired_[i] &&
          (tracks[j].position - truth[i]).norm() <= radius_) {
        track_of[i] = j;
        taken[j] = 1;
      }
  PairGains gains(n, m);
  for (int i = 0; i < n; ++i) {
    gains.start_row();
    for (int j = 0; j < m && track_of[i] == kFree; ++j) {
      const double distance = (tracks[j].position - truth[i]).norm();
      if (!taken[j] && distance <= radius_) gains.add(j, kUnpaired - distance);
    }
  }
  const Assignment assignment(gains);
  int pairs = 0;
  for (int i = 0; i < n; ++i) {
    if (track_of[i] == kFree && assignment.choice(i) != Assignment::kNone)
      track_of[i] = assignment.choice(i);
    paired_[i] = kNone;
    if (track_of[i] == kFree) continue;
    ++pairs;
    paired_[i] = static_cast<std::int64_t>(tracks[track_of[i]].id);
    if (last_[i] != kNone && last_[i] != paired_[i]) ++switches;
    last_[i] = paired_[i];
  }
  objects += n;
  misses += n - pairs;
  strays += m - pairs;
}

}  // namespace anchord::bench
