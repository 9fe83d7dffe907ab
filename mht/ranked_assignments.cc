#include "mht/ranked_assignments.h"

#include <algorithm>
#include <utility>

#include "core/log_probability.h"

namespace anchord {

RankedAssignments::RankedAssignments(PairGains gains, double most_loss)
    : gains_(std::move(gains)), most_loss_(most_loss) {
  if (gains_.detections() == 1) {
    rank_one_detection();
    return;
  }
  Assignment best(gains_);
  const double gain = best.gain(gains_);
  rank(best, gain);
  branch({gain, true, 0, {}, std::move(best)});
}

void RankedAssignments::rank_one_detection() {
  ranked_.push_back({0, {Assignment::kNone}});
  for (const auto& [leaf, gain] : gains_.of(0)) ranked_.push_back({gain, {leaf}});
  std::stable_sort(ranked_.begin(), ranked_.end(),
                   [](const Ranked& a, const Ranked& b) { return a.gain > b.gain; });
  while (ranked_.back().gain < ranked_.front().gain - most_loss_) ranked_.pop_back();
}

void RankedAssignments::rank(const Assignment& assignment, double gain) {
  Ranked ranked{gain, {}};
  for (int z = 0; z < assignment.detections(); ++z) ranked.leaf_of.push_back(assignment.choice(z));
  ranked_.push_back(std::move(ranked));
}

void RankedAssignments::enter(Entry entry) {
  heap_.push_back(entry);
  std::push_heap(heap_.begin(), heap_.end());
}

void RankedAssignments::branch(Part part) {
  const double least = ranked_.front().gain - most_loss_;
  for (int z = part.first; z < gains_.detections(); ++z) {
    Assignment::Banned banned;
    if (z == part.first) banned = part.banned;
    banned.push_back(part.assignment.choice(z));
    const double bound = part.bound - part.assignment.least_loss(z, banned, gains_);
    if (bound < least || bound == kLogZero) continue;
    enter({bound, parts_.size()});
    parts_.push_back({bound, false, z, std::move(banned), part.assignment});
  }
}

bool RankedAssignments::find_next() {
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const std::size_t index = heap_.back().part;
    heap_.pop_back();
    Part& part = parts_[index];
    if (!part.solved) {
      if (!part.assignment.reassign(part.first, part.banned, gains_)) continue;
      part.solved = true;
      part.bound = part.assignment.gain(gains_);
      if (part.bound < ranked_.front().gain - most_loss_) continue;
      if (!heap_.empty() && part.bound < heap_.front().bound) {
        enter({part.bound, index});
        continue;
      }
    }
    rank(part.assignment, part.bound);
    branch(std::move(part));
    return true;
  }
  return false;
}

const RankedAssignments::Ranked* RankedAssignments::at(std::size_t i) {
  while (i >= ranked_.size())
    if (!find_next()) return nullptr;
  return &ranked_[i];
}

}  // namespace anchord
