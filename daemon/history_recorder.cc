#include "daemon/history_recorder.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "anchoring/reading.h"

namespace anchord {
namespace {

/// Objects that are less probable have no history yet.
constexpr double kLeastP = 0.05;

bool differs(const HistorySample& a, const HistorySample& b) {
  if (a.place != b.place) return true;
  if (std::abs(a.p - b.p) >= HistoryRecorder::kLeastChange) return true;
  const double move = std::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1],
                                 a.position[2] - b.position[2]);
  return move > std::max(HistoryRecorder::kLeastMove, 0.5 * std::max(a.spread, b.spread));
}

}  // namespace

HistorySample sample_of(const ObjectBelief& object, Utime utime, const Background& background) {
  const Gaussian where = object.moments(background);
  HistorySample out{object.anchor->id(), utime, object.p, "", {}, 0};
  for (int axis = 0; axis < background.dims; ++axis) out.position[axis] = where.mean[axis];
  out.spread = std::sqrt(std::max(0.0, (where.covariance(0, 0) + where.covariance(1, 1)) / 2));
  if (const int place = object.place(background); place >= 0)
    out.place = background.knowledge.places[place].name;
  return out;
}

std::vector<HistorySample> HistoryRecorder::look(const std::shared_ptr<const Belief>& belief,
                                                 const Background& background,
                                                 const LastSample& last) {
  std::vector<HistorySample> out;
  if (belief->frames == 0) return out;
  if (seen_ && seconds_between(seen_->utime, belief->utime) < grain_) return out;
  std::unordered_set<const Cluster*> seen;
  if (seen_)
    for (const auto& cluster : seen_->clusters) seen.insert(cluster.get());
  std::unordered_set<std::string> here;
  for (const auto& cluster : belief->clusters) {
    if (seen.erase(cluster.get()) > 0) continue;
    for (const ObjectBelief& object : read_objects(*cluster, belief->utime, background)) {
      if (object.anchor->name.empty() || object.p < kLeastP) continue;
      HistorySample sample = sample_of(object, belief->utime, background);
      here.insert(sample.object);
      auto known = last_.find(sample.object);
      if (known == last_.end())
        if (auto logged = last(sample.object)) known = last_.emplace(sample.object, *logged).first;
      if (known != last_.end() && !differs(known->second, sample)) continue;
      last_.insert_or_assign(sample.object, sample);
      out.push_back(std::move(sample));
    }
  }
  // Those in clusters that are there no more, or hardly probable any more.
  if (seen_)
    for (const auto& cluster : seen_->clusters) {
      if (!seen.contains(cluster.get())) continue;
      for (const AnchorTree& tree : cluster->anchors) {
        const auto known = last_.find(tree.anchor->id());
        if (known == last_.end() || here.contains(known->first)) continue;
        HistorySample gone = known->second;
        gone.utime = belief->utime;
        gone.p = 0;
        gone.place.clear();
        out.push_back(std::move(gone));
        last_.erase(known);
      }
    }
  seen_ = belief;
  return out;
}

void HistoryRecorder::forget() {
  seen_.reset();
  last_.clear();
}

}  // namespace anchord
