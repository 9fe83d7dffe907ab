#include "mht/ranked_assignments.h"

#include <algorithm>
#include <utility>

#include "core/log_probability.h"

namespace anchord {
namespace {

/// At most so many assignments are all found at once.
constexpr std::size_t kFew = 64;

/// Every assignment of a small problem, by recursion over the detections.
class Everything {
 public:
  Everything(const PairGains& gains, double most_loss) : gains_(gains), most_loss_(most_loss) {
    const int n = gains.detections();
    chosen.assign(n, Assignment::kNone);
    rest_.assign(n + 1, 0.0);
    for (int z = n - 1; z >= 0; --z) {
      double most = 0;
      for (const auto& pair : gains.of(z)) most = std::max(most, pair.gain);
      rest_[z] = rest_[z + 1] + most;
    }
  }

  /// Calls `found(gain)` for each that is not too far below the best so far, while it is `chosen`.
  template <typename Found>
  void visit(int z, double gain, const Found& found) {
    if (gain + rest_[z] < best_ - most_loss_) return;
    if (z == gains_.detections()) {
      best_ = std::max(best_, gain);
      found(gain);
      return;
    }
    const auto end = chosen.begin() + z;
    for (const auto& pair : gains_.of(z)) {
      if (std::find(chosen.begin(), end, pair.leaf) != end) continue;
      chosen[z] = pair.leaf;
      visit(z + 1, gain + pair.gain, found);
    }
    chosen[z] = Assignment::kNone;
    visit(z + 1, gain, found);
  }

  SmallScratchVector<int, 8> chosen;

 private:
  const PairGains& gains_;
  double most_loss_, best_ = kLogZero;
  SmallScratchVector<double, 8> rest_;  // what the detections from z on gain at most
};

}  // namespace

RankedAssignments::RankedAssignments(PairGains gains, double most_loss)
    : gains_(std::move(gains)), most_loss_(most_loss) {
  std::size_t most = 1;
  for (int z = 0; z < gains_.detections() && most <= kFew; ++z)
    most *= 1 + (gains_.of(z).end() - gains_.of(z).begin());
  if (most <= kFew) {
    rank_all();
    return;
  }
  Assignment best(gains_);
  const double gain = best.gain(gains_);
  rank(best, gain);
  branch({gain, true, 0, {}, std::move(best)});
}

void RankedAssignments::rank_all() {
  Everything all(gains_, most_loss_);
  all.visit(0, 0, [&](double gain) {
    ranked_.push_back({gain, choices_.size()});
    choices_.insert(choices_.end(), all.chosen.begin(), all.chosen.end());
  });
  std::sort(ranked_.begin(), ranked_.end(), [](const Ranked& a, const Ranked& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.first < b.first;
  });
  while (ranked_.back().gain < ranked_.front().gain - most_loss_) ranked_.pop_back();
}

void RankedAssignments::rank(const Assignment& assignment, double gain) {
  ranked_.push_back({gain, choices_.size()});
  for (int z = 0; z < assignment.detections(); ++z) choices_.push_back(assignment.choice(z));
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

bool RankedAssignments::has(std::size_t i) {
  while (i >= ranked_.size())
    if (!find_next()) return false;
  return true;
}

}  // namespace anchord
