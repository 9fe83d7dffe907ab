#pragma once

#include "mht/assignment.h"

namespace anchord {

/// Every assignment that loses little against an optimal one.
///
/// Each is the optimal one with some changes in it that have no detection in common: chains, in
/// which one takes what the next has, and the last what nobody has (or none), while nobody takes
/// what the first had; and cycles. What a change loses is the slack of the pairs that it takes, and
/// the price of what it leaves. Changes are built pair by pair, each bounded by the cheapest way in
/// which it can still end, so that next to none is begun in vain.
class NearBest {
 public:
  /// Assignments that lose more than `most_loss` are left out. The arguments must outlive this.
  NearBest(const PairGains& gains, const Assignment& best, double most_loss);

  /// One of them.
  struct Found {
    double loss;        ///< of gain, against the optimal one
    std::size_t first;  ///< where its choices begin in choices(), one per detection
  };
  /// Finds them all, the optimal one first, the others in no order. False if that takes more than
  /// `most_steps` pairs; what has been found is of no use then.
  bool find_all(int most_steps);
  const ScratchVector<Found>& found() const { return found_; }
  /// Leaves, or Assignment::kNone, of all that were found.
  const ScratchVector<int>& choices() const { return choices_; }

 private:
  struct Step {
    int next;  // who has the leaf; nobody_
    int choice;
    double slack;
  };
  void find_ways();
  bool chains_from(int first, double loss);
  bool cycles_from(int first, double loss);
  bool go_on(int at, int start, double loss, bool chain);
  void note(double loss);

  const PairGains& gains_;
  const Assignment& best_;
  double most_loss_;
  int n_, nobody_;
  ScratchVector<std::size_t> first_step_;  // per detection
  ScratchVector<Step> steps_;
  ScratchVector<double> way_;  // of least slack, from one to another and, last, to nobody
  ScratchVector<int> chosen_;
  ScratchVector<char> changed_;  // per detection
  ScratchVector<char> taken_;    // per leaf that the best one leaves free
  ScratchVector<Found> found_;
  ScratchVector<int> choices_;
  int steps_left_ = 0;
};

}  // namespace anchord
