#pragma once

#include "core/scratch.h"
#include "mht/assignment.h"

namespace anchord {

/// All assignments of a problem, best first. Where few are near the best, they are all found at
/// once. Of many the next is found when asked for: what is left of a solved problem is split by
/// which detection is the first to change its choice (Murty 1968), and a part is solved only when
/// its bound comes to the top (Miller, Stone, Cox 1997). Ties come in a fixed order.
class RankedAssignments {
 public:
  /// Assignments that gain less than the best one by more than `most_loss` may be left out.
  /// `few_are_near`: that leaves few, as far as is known.
  RankedAssignments(PairGains gains, double most_loss, bool few_are_near = false);

  /// Whether there is an i-th best, counted from 0.
  bool has(std::size_t i);
  /// What it gains. The i-th must be there.
  double gain(std::size_t i) const { return ranked_[i].gain; }
  /// ln of the sum of e^gain over all that have been ranked so far: all there are, where they are
  /// few.
  double log_total() const;
  /// What a detection is given to in it: a leaf or Assignment::kNone.
  int leaf_of(std::size_t i, int z) const { return choices_[ranked_[i].first + z]; }

 private:
  struct Ranked {
    double gain;
    std::size_t first;  // where its choices begin
  };
  struct Part {
    double bound;  // gain, exact once solved
    bool solved;
    int first;  // detections before keep their choice; this one has lost those in banned
    Assignment::Banned banned;
    std::size_t assignment;  // in solved_: its own, or of the part that it comes from
  };
  struct Entry {
    double bound;
    std::size_t part;  // in order of creation: breaks ties
    bool operator<(const Entry& other) const {
      return bound != other.bound ? bound < other.bound : part > other.part;
    }
  };
  void rank_one();
  void rank_all(std::size_t most);
  void sort();
  bool rank_near(const Assignment& best, double gain);
  void rank(const Assignment& assignment, double gain);
  void enter(Entry entry);
  void branch(double gain, int first, const Assignment::Banned& banned, std::size_t assignment);
  bool find_next();

  PairGains gains_;
  double most_loss_;
  ScratchVector<Ranked> ranked_;
  ScratchVector<int> choices_;
  ScratchVector<Assignment> solved_;
  ScratchVector<Part> parts_;
  ScratchVector<Entry> heap_;
};

}  // namespace anchord
