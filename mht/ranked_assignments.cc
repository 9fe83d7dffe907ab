#include "mht/ranked_assignments.h"

#include <algorithm>
#include <utility>

#include "core/log_probability.h"
#include "mht/near_best.h"

namespace anchord {
namespace {

/// So few assignments are all found at once.
constexpr std::size_t kFew = 64;
/// Where few are expected, the search for all of them may take so many steps; so many detections
/// may choose, since the steps are prepared in time of their third power.
constexpr int kMostSteps = 10000, kMostDetections = 64;

/// How many there are at most if each detection may choose freely; more than kFew count as kFew
/// + 1.
std::size_t most_of(const PairGains& gains) {
  std::size_t most = 1;
  for (int z = 0; z < gains.detections(); ++z) {
    most *= 1 + (gains.of(z).end() - gains.of(z).begin());
    if (most > kFew) return kFew + 1;
  }
  return most;
}

/// Calls `found(gain)` for every assignment of the detections from `z` on, with the choices of all
/// in `chosen`; those that gain less than `least` may be left out. `most` is per detection what it
/// and those after it may gain together.
template <typename Found>
void visit_all(const PairGains& gains, int z, int* chosen, double gain, double least,
               const double* most, const Found& found) {
  if (z == gains.detections()) {
    found(gain);
    return;
  }
  if (gain + most[z + 1] >= least) {
    chosen[z] = Assignment::kNone;
    visit_all(gains, z + 1, chosen, gain, least, most, found);
  }
  for (const auto& pair : gains.of(z)) {
    if (gain + pair.gain + most[z + 1] < least ||
        std::find(chosen, chosen + z, pair.leaf) != chosen + z)
      continue;
    chosen[z] = pair.leaf;
    visit_all(gains, z + 1, chosen, gain + pair.gain, least, most, found);
  }
}

/// What an assignment gains in which each detection in turn takes the best that is left.
double greedy_gain(const PairGains& gains, int* chosen) {
  double sum = 0;
  for (int z = 0; z < gains.detections(); ++z) {
    PairGains::Entry best{Assignment::kNone, 0};
    for (const auto& pair : gains.of(z))
      if (pair.gain > best.gain && std::find(chosen, chosen + z, pair.leaf) == chosen + z)
        best = pair;
    chosen[z] = best.leaf;
    sum += best.gain;
  }
  return sum;
}

}  // namespace

RankedAssignments::RankedAssignments(PairGains gains, double most_loss, bool few_are_near)
    : gains_(std::move(gains)), most_loss_(most_loss) {
  if (gains_.detections() == 1) {
    rank_one();
    return;
  }
  if (const std::size_t most = most_of(gains_); most <= kFew) {
    rank_all(most);
    return;
  }
  Assignment best(gains_);
  const double gain = best.gain(gains_);
  if (few_are_near && gains_.detections() <= kMostDetections && rank_near(best, gain)) return;
  rank(best, gain);
  solved_.push_back(std::move(best));
  branch(gain, 0, {}, 0);
}

void RankedAssignments::rank_one() {
  const auto row = gains_.of(0);
  const std::size_t most = 1 + (row.end() - row.begin());
  ranked_.reserve(most);
  choices_.reserve(most);
  const auto add = [&](double gain, int choice) {
    ranked_.push_back({gain, choices_.size()});
    choices_.push_back(choice);
  };
  add(0, Assignment::kNone);
  for (const auto& pair : row) add(pair.gain, pair.leaf);
  sort();
}

void RankedAssignments::rank_all(std::size_t most) {
  const int n = gains_.detections();
  ScratchVector<int> chosen(n);
  ScratchVector<double> most_from(n + 1, 0.0);
  for (int z = n; z-- > 0;) {
    for (const auto& pair : gains_.of(z)) most_from[z] = std::max(most_from[z], pair.gain);
    most_from[z] += most_from[z + 1];
  }
  ranked_.reserve(most);
  choices_.reserve(most * n);
  // Room for rounding: sort() decides.
  const double least = greedy_gain(gains_, chosen.data()) - most_loss_ - 1e-6;
  visit_all(gains_, 0, chosen.data(), 0, least, most_from.data(), [&](double gain) {
    ranked_.push_back({gain, choices_.size()});
    choices_.insert(choices_.end(), chosen.begin(), chosen.end());
  });
  sort();
}

bool RankedAssignments::rank_near(const Assignment& best, double gain) {
  NearBest near(gains_, best, most_loss_);
  if (!near.find_all(kMostSteps)) return false;
  for (const auto& [loss, first] : near.found()) ranked_.push_back({gain - loss, first});
  choices_ = near.choices();
  sort();
  return true;
}

/// What is too far below the best goes.
void RankedAssignments::sort() {
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

void RankedAssignments::branch(double gain, int first, const Assignment::Banned& banned,
                               std::size_t assignment) {
  const Assignment& of = solved_[assignment];
  const double least = ranked_.front().gain - most_loss_;
  for (int z = first; z < gains_.detections(); ++z) {
    Assignment::Banned lost;
    if (z == first) lost = banned;
    lost.push_back(of.choice(z));
    const double bound = gain - of.least_loss(z, lost, gains_);
    if (bound < least || bound == kLogZero) continue;
    enter({bound, parts_.size()});
    parts_.push_back({bound, false, z, std::move(lost), assignment});
  }
}

bool RankedAssignments::find_next() {
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const std::size_t index = heap_.back().part;
    heap_.pop_back();
    Part& part = parts_[index];
    if (!part.solved) {
      Assignment own = solved_[part.assignment];
      if (!own.reassign(part.first, part.banned, gains_)) continue;
      part.solved = true;
      part.bound = own.gain(gains_);
      if (part.bound < ranked_.front().gain - most_loss_) continue;
      part.assignment = solved_.size();
      solved_.push_back(std::move(own));
      if (!heap_.empty() && part.bound < heap_.front().bound) {
        enter({part.bound, index});
        continue;
      }
    }
    const Part found = std::move(part);
    rank(solved_[found.assignment], found.bound);
    branch(found.bound, found.first, found.banned, found.assignment);
    return true;
  }
  return false;
}

double RankedAssignments::log_total() const {
  return log_sum(ranked_, [](const Ranked& ranked) { return ranked.gain; });
}

bool RankedAssignments::has(std::size_t i) {
  while (i >= ranked_.size())
    if (!find_next()) return false;
  return true;
}

}  // namespace anchord
