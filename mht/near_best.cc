#include "mht/near_best.h"

#include <algorithm>
#include <limits>

namespace anchord {

NearBest::NearBest(const PairGains& gains, const Assignment& best, double most_loss)
    : gains_(gains), best_(best), most_loss_(most_loss), n_(gains.detections()), nobody_(n_) {
  ScratchVector<int> owner(gains.leaves(), nobody_);
  for (int z = 0; z < n_; ++z) {
    chosen_.push_back(best.choice(z));
    if (best.choice(z) != Assignment::kNone) owner[best.choice(z)] = z;
  }
  changed_.assign(n_, 0);
  taken_.assign(gains.leaves(), 0);
  for (int z = 0; z < n_; ++z) {
    first_step_.push_back(steps_.size());
    const auto add = [&](int next, int choice, double slack) {
      if (slack <= most_loss_) steps_.push_back({next, choice, std::max(slack, 0.0)});
    };
    for (const auto& pair : gains_.of(z))
      if (pair.leaf != best.choice(z)) add(owner[pair.leaf], pair.leaf, best.slack(z, pair));
    if (best.choice(z) != Assignment::kNone) add(nobody_, Assignment::kNone, best.slack_of_none(z));
  }
  first_step_.push_back(steps_.size());
  find_ways();
}

/// Floyd and Warshall, over those who lose a leaf.
void NearBest::find_ways() {
  const int width = n_ + 1;
  way_.assign(static_cast<std::size_t>(n_) * width, std::numeric_limits<double>::infinity());
  const auto way = [&](int from) { return way_.data() + static_cast<std::size_t>(from) * width; };
  for (int z = 0; z < n_; ++z) {
    way(z)[z] = 0;
    for (std::size_t i = first_step_[z]; i < first_step_[z + 1]; ++i)
      way(z)[steps_[i].next] = std::min(way(z)[steps_[i].next], steps_[i].slack);
  }
  for (int over = 0; over < n_; ++over)
    for (int from = 0; from < n_; ++from) {
      const double so_far = way(from)[over];
      if (so_far > most_loss_) continue;
      for (int to = 0; to < width; ++to)
        way(from)[to] = std::min(way(from)[to], so_far + way(over)[to]);
    }
}

bool NearBest::find_all(int most_steps) {
  steps_left_ = most_steps;
  note(0);
  return chains_from(0, 0) && cycles_from(0, 0);
}

void NearBest::note(double loss) {
  found_.push_back({loss, choices_.size()});
  choices_.insert(choices_.end(), chosen_.begin(), chosen_.end());
}

/// More changes: chains, whose first is `first` or a later one; then cycles.
bool NearBest::chains_from(int first, double loss) {
  for (int z = first; z < n_; ++z)
    if (!changed_[z] && !go_on(z, z, loss + best_.price_of_choice(z), true)) return false;
  return true;
}

/// Cycles, whose least is `first` or a later one.
bool NearBest::cycles_from(int first, double loss) {
  for (int z = first; z < n_; ++z)
    if (!changed_[z] && !go_on(z, z, loss, false)) return false;
  return true;
}

/// All that `at` may take as part of a change that began with `start`.
bool NearBest::go_on(int at, int start, double loss, bool chain) {
  const int width = n_ + 1, goal = chain ? nobody_ : start;
  changed_[at] = 1;
  bool whole = true;
  for (std::size_t i = first_step_[at]; i < first_step_[at + 1] && whole; ++i) {
    const auto [next, choice, slack] = steps_[i];
    const double so_far = loss + slack;
    const bool is_free = next == nobody_ && choice != Assignment::kNone;
    if (next == goal) {
      if (so_far > most_loss_ || (is_free && taken_[choice])) continue;
      if (--steps_left_ < 0) return false;
      chosen_[at] = choice;
      if (is_free) taken_[choice] = 1;
      note(so_far);
      whole =
          (!chain || chains_from(start + 1, so_far)) && cycles_from(chain ? 0 : start + 1, so_far);
      if (is_free) taken_[choice] = 0;
      continue;
    }
    // A cycle begins with the least in it.
    if (next == nobody_ || changed_[next] || (!chain && next < start)) continue;
    if (so_far + way_[static_cast<std::size_t>(next) * width + goal] > most_loss_) continue;
    if (--steps_left_ < 0) return false;
    chosen_[at] = choice;
    whole = go_on(next, start, so_far, chain);
  }
  changed_[at] = 0;
  chosen_[at] = best_.choice(at);
  return whole;
}

}  // namespace anchord
