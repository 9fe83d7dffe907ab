#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/log_probability.h"
#include "mht/assignment.h"

namespace anchord {

/// One frame's association within a cluster, in log-weights. Leaves and detections are numbers.
struct AssociationProblem {
  /// A hypothesis before the frame, its leaves taken as if each gave nothing and every detection
  /// as new or clutter.
  struct Parent {
    double log_weight = 0;
    std::vector<int> leaves;  ///< rows of `gain`
  };
  int detections = 0;
  /// gain[leaf * detections + z]: ln of what it is worth to give z to the leaf instead,
  /// ln (r g / (1 - r q)) - ln (kappa + e); kLogZero where it cannot be.
  std::vector<double> gain;
  std::vector<Parent> parents;
};

/// One hypothesis after the frame.
struct Association {
  static constexpr int kNone = -1;
  int parent = 0;
  double log_weight = 0;
  boost::container::small_vector<int, 8>
      leaf_of;  ///< per detection a position in the parent's `leaves`, or kNone
};

/// All associations of a problem, best first, over all parents at once: one heap of subproblems
/// (Murty 1968), each entered with a bound and solved only when it comes to the top (Miller, Stone,
/// Cox 1997). Ties come in a fixed order.
class RankedAssociations {
 public:
  /// Associations whose log-weight is less than the best one's plus `log_least` may be left out.
  explicit RankedAssociations(const AssociationProblem& problem, double log_least = kLogZero);

  /// The next best, or nothing when all have been given.
  std::optional<Association> next();

 private:
  struct Node {
    double bound;  // log weight, exact once solved
    int parent;
    bool solved;
    int banned_row;                                 // the row that must change, -1 for a root
    Assignment assignment;                          // of the node it came from, until solved
    RowFlags fixed;                                 // rows that may not change
    boost::container::small_vector<int, 8> banned;  // entries of the cost matrix made infinite
  };
  /// A node's place in the heap.
  struct Entry {
    double bound;
    std::size_t node;  // in order of creation: breaks ties
    bool operator<(const Entry& other) const {
      return bound != other.bound ? bound < other.bound : node > other.node;
    }
  };
  const std::vector<double>& costs_of(int parent);
  bool solve(Node& node);
  void branch(const Node& node);
  void push(Node node);
  void enter(Entry entry);

  const AssociationProblem& problem_;
  std::vector<std::vector<double>> costs_;  // per parent, made when first needed
  std::vector<double> scratch_;
  std::deque<Node> nodes_;
  std::vector<Entry> heap_;
  double log_least_;
  double least_bound_ = kLogZero;  // of nodes worth keeping, once the best is known
};

}  // namespace anchord
