#pragma once

#include "core/scratch.h"
#include "mht/pair_gains.h"

namespace anchord {

/// Which leaf each detection is given to, at most one detection to a leaf, or to none (worth 0):
/// the assignment of most gain, with the prices that prove it.
///
/// Prices are at least 0 (of who may not go without, they may be less), a pair's gain is at most
/// the sum of its prices, just that for pairs that are chosen, and who goes without has price 0.
/// Solved by shortest augmenting paths on what is left of that sum, the slack (Jonker and Volgenant
/// 1987). A solution that loses a pair goes on from its prices: one path, which is what ranking
/// needs (Miller, Stone, Cox 1997). A value: copies share nothing; the gains stay with the caller.
class Assignment {
 public:
  static constexpr int kNone = -1;
  /// Choices that a detection has lost: leaves, or kNone.
  using Banned = SmallScratchVector<int, 4>;

  /// The optimum.
  explicit Assignment(const PairGains& gains);

  /// Goes on to the optimum after detection z has lost its choice and the others in `banned`, and
  /// the detections before z may not change theirs. False if there is none; the object is then
  /// spent.
  bool reassign(int z, const Banned& banned, const PairGains& gains);

  /// What detection z is given to: a leaf or kNone.
  int choice(int z) const { return choice_[z]; }
  int detections() const { return static_cast<int>(choice_.size()); }

  double gain(const PairGains& gains) const;

  /// A lower bound on what it loses if z may not keep its choice: the least slack among the other
  /// choices that it has, where the detections before it keep theirs.
  double least_loss(int z, const Banned& banned, const PairGains& gains) const;

  /// What the prices leave of a pair; of kNone.
  double slack(int z, const PairGains::Entry& pair) const {
    return row_price_[z] + column_price_[pair.leaf] - pair.gain;
  }
  double slack_of_none(int z) const { return row_price_[z]; }
  /// The price of what detection z is given to: what it costs if nobody has that.
  double price_of_choice(int z) const {
    return choice_[z] == kNone ? 0 : column_price_[choice_[z]];
  }

 private:
  static constexpr int kFree = -1;
  void augment(int z, const PairGains& gains);
  class Search;

  // Per detection and per leaf.
  SmallScratchVector<int, 8> choice_, owner_;
  SmallScratchVector<double, 8> row_price_, column_price_;
};

}  // namespace anchord
