#pragma once

#include <vector>

#include "mht/assignment.h"

namespace anchord {

/// All assignments of a problem, best first, found when asked for: what is left of a solved problem
/// is split by which detection is the first to change its choice (Murty 1968), and a part is solved
/// only when its bound comes to the top (Miller, Stone, Cox 1997). Ties come in a fixed order.
class RankedAssignments {
 public:
  struct Ranked {
    double gain;
    boost::container::small_vector<int, 4> leaf_of;  ///< per detection a leaf or kNone
  };

  /// Assignments that gain less than the best one by more than `most_loss` may be left out.
  RankedAssignments(PairGains gains, double most_loss);

  /// The i-th best, counted from 0, or null where there are no more. Valid until the next call.
  const Ranked* at(std::size_t i);

 private:
  struct Part {
    double bound;  // gain, exact once solved
    bool solved;
    int first;  // detections before keep their choice; this one has lost those in banned
    Assignment::Banned banned;
    Assignment assignment;  // of the part it came from, until solved
  };
  struct Entry {
    double bound;
    std::size_t part;  // in order of creation: breaks ties
    bool operator<(const Entry& other) const {
      return bound != other.bound ? bound < other.bound : part > other.part;
    }
  };
  void rank_one_detection();
  void rank(const Assignment& assignment, double gain);
  void enter(Entry entry);
  void branch(Part part);
  bool find_next();

  PairGains gains_;
  double most_loss_;
  std::vector<Ranked> ranked_;
  std::vector<Part> parts_;
  std::vector<Entry> heap_;
};

}  // namespace anchord
