#include "mht/assignment.h"

#include <algorithm>
#include <limits>

namespace anchord {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool contains(const Assignment::Banned& banned, int choice) {
  return std::find(banned.begin(), banned.end(), choice) != banned.end();
}

}  // namespace

/// Dijkstra from detection z, whose choice was taken away, over detections that lose theirs to one
/// before them. A path may end in a leaf that nobody has, or in none. If z had a choice before, the
/// one who gets that must be found, too: then whoever ends the path so makes room for "nobody", who
/// may take any choice at its price and ends the search by taking what z has lost.
class Assignment::Search {
 public:
  Search(Assignment& a, const PairGains& gains, int z)
      : a_(a), gains_(gains), z_(z), distance_(a.detections(), kInfinite), from_(a.detections()) {
    distance_[z] = 0;
    from_[z] = kStart;
    reached_.push_back(z);
  }

  static constexpr int kNothing = -2;

  /// False if there is no end. `lost`: what z has lost; kNothing where it had no choice before.
  bool run(int lost, const Banned& banned) {
    lost_ = lost;
    first_free_ = lost == kNothing ? 0 : z_;
    while (true) {
      const std::size_t at = nearest();
      const double row_distance = at < reached_.size() ? distance_[reached_[at]] : kInfinite;
      const double nobody_distance = nobody_is_done_ ? kInfinite : nobody_distance_;
      if (end_ <= std::min(row_distance, nobody_distance)) break;
      if (nobody_distance <= row_distance) {
        if (lost_ == kNothing) {
          end_ = nobody_distance;
          break;
        }
        relax_nobody();
        continue;
      }
      const int row = reached_[at];
      reached_[at] = reached_.back();
      reached_.pop_back();
      done_.push_back(row);
      relax(row, banned);
    }
    if (end_ == kInfinite) return false;
    update_prices();
    follow();
    return true;
  }

 private:
  static constexpr int kStart = -3, kNobody = -4;

  /// Where in `reached_` the nearest detection stands; behind it if there is none.
  std::size_t nearest() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < reached_.size(); ++i)
      if (distance_[reached_[i]] < distance_[reached_[best]]) best = i;
    return best;
  }

  void reach(int row, int from, double distance) {
    if (!(distance < distance_[row])) return;
    if (distance_[row] == kInfinite) reached_.push_back(row);
    distance_[row] = distance;
    from_[row] = from;
  }

  void relax(int row, const Banned& banned) {
    const double base = distance_[row];
    const auto may = [&](int choice) { return row != z_ || !contains(banned, choice); };
    for (const PairGains::Entry& pair : gains_.of(row)) {
      const int owner = a_.owner_[pair.leaf];
      if (pair.leaf == a_.choice_[row] || (owner != kFree && owner < first_free_) ||
          !may(pair.leaf))
        continue;
      const double distance = base + std::max(a_.slack(row, pair), 0.0);
      if (pair.leaf == lost_)
        end_at(distance, row, pair.leaf);
      else if (owner != kFree)
        reach(owner, row, distance);
      else
        make_room(distance, row, pair.leaf);
    }
    const bool has_none = row == z_ ? lost_ == kNone : a_.choice_[row] == kNone;
    if (!has_none && may(kNone)) make_room(base + std::max(a_.slack_of_none(row), 0.0), row, kNone);
  }

  void relax_nobody() {
    nobody_is_done_ = true;
    const double base = nobody_distance_;
    end_at(base + (lost_ == kNone ? 0 : a_.column_price_[lost_]), kNobody, lost_);
    for (int row = z_ + 1; row < a_.detections(); ++row) {
      const int choice = a_.choice_[row];
      reach(row, kNobody, base + (choice == kNone ? 0 : a_.column_price_[choice]));
    }
  }

  void end_at(double distance, int row, int choice) {
    if (distance < end_) end_ = distance, end_row_ = row, end_choice_ = choice;
  }
  void make_room(double distance, int row, int choice) {
    if (distance < nobody_distance_)
      nobody_distance_ = distance, room_row_ = row, room_choice_ = choice;
  }

  /// Prices of who was passed, so that the path has no slack; all of them shifted so that the free
  /// ones stay 0.
  void update_prices() {
    const double shift = nobody_is_done_ ? end_ - nobody_distance_ : 0;
    if (shift > 0) {
      for (double& price : a_.row_price_) price += shift;
      for (int leaf = 0; leaf < static_cast<int>(a_.owner_.size()); ++leaf)
        if (a_.owner_[leaf] != kFree || leaf == lost_) a_.column_price_[leaf] -= shift;
    }
    for (const int row : done_) {
      const double closer = end_ - distance_[row];
      if (closer <= 0) continue;
      a_.row_price_[row] -= closer;
      if (row != z_ && a_.choice_[row] != kNone) a_.column_price_[a_.choice_[row]] += closer;
    }
  }

  void follow() {
    int row = end_row_, choice = end_choice_;
    if (lost_ == kNothing || row == kNobody) row = room_row_, choice = room_choice_;
    while (true) {
      const int before = row == z_ ? kNone : a_.choice_[row];
      a_.choice_[row] = choice;
      if (choice != kNone) a_.owner_[choice] = row;
      if (row == z_) break;
      if (from_[row] == kNobody) {
        if (before != kNone) a_.owner_[before] = kFree;
        row = room_row_, choice = room_choice_;
      } else {
        row = from_[row], choice = before;
      }
    }
  }

  Assignment& a_;
  const PairGains& gains_;
  int z_, lost_ = kNothing, first_free_ = 0;  // detections before keep their choices
  SmallScratchVector<double, 16> distance_;
  SmallScratchVector<int, 16> from_, reached_, done_;
  double end_ = kInfinite, nobody_distance_ = kInfinite;
  int end_row_ = -1, end_choice_ = kNone, room_row_ = -1, room_choice_ = kNone;
  bool nobody_is_done_ = false;
};

Assignment::Assignment(const PairGains& gains)
    : choice_(gains.detections(), kNone),
      owner_(gains.leaves(), kFree),
      row_price_(gains.detections(), 0.0),
      column_price_(gains.leaves(), 0.0) {
  for (int z = 0; z < gains.detections(); ++z) augment(z, gains);
}

void Assignment::augment(int z, const PairGains& gains) {
  double price = 0;
  int best = kNone;
  for (const PairGains::Entry& pair : gains.of(z))
    if (const double rest = pair.gain - column_price_[pair.leaf]; rest > price)
      price = rest, best = pair.leaf;
  row_price_[z] = price;
  if (best == kNone || owner_[best] == kFree) {
    choice_[z] = best;
    if (best != kNone) owner_[best] = z;
    return;
  }
  // Detections after z have no choice yet, nor are they asked.
  Search(*this, gains, z).run(Search::kNothing, {});
}

bool Assignment::reassign(int z, const Banned& banned, const PairGains& gains) {
  const int lost = choice_[z];
  if (lost != kNone) owner_[lost] = kFree;
  return Search(*this, gains, z).run(lost, banned);
}

double Assignment::gain(const PairGains& gains) const {
  double sum = 0;
  for (int z = 0; z < detections(); ++z) {
    if (choice_[z] == kNone) continue;
    for (const PairGains::Entry& pair : gains.of(z))
      if (pair.leaf == choice_[z]) sum += pair.gain;
  }
  return sum;
}

double Assignment::least_loss(int z, const Banned& banned, const PairGains& gains) const {
  double least = kInfinite;
  if (choice_[z] != kNone && !contains(banned, kNone)) least = slack_of_none(z);
  for (const PairGains::Entry& pair : gains.of(z)) {
    const int owner = owner_[pair.leaf];
    if (pair.leaf == choice_[z] || (owner != kFree && owner < z) || contains(banned, pair.leaf))
      continue;
    least = std::min(least, slack(z, pair));
  }
  return std::max(least, 0.0);
}

}  // namespace anchord
