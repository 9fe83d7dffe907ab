#pragma once

#include <optional>

#include "core/log_probability.h"
#include "mht/association_problem.h"
#include "mht/components.h"

namespace anchord {

/// All associations of a problem, best first, over all parents at once. What a parent's detections
/// may be given to falls apart into components that are ranked on their own, once for all parents
/// that share them; one heap merges the products of their rankings, of which it forms no more than
/// are asked for. Ties come in a fixed order.
class RankedAssociations {
 public:
  /// Associations whose log-weight is less than the best one's plus `log_least` may be left out.
  explicit RankedAssociations(const AssociationProblem& problem, double log_least = kLogZero);

  /// The next best, or nothing when all have been given.
  std::optional<Association> next();

  /// The best association of one parent, whether it has been given or not.
  Association best_of(int parent);

  /// ln of the weight of all associations of each parent together, whether they have been given or
  /// not; as far as large components have been ranked.
  ScratchVector<double> log_evidence() const;

 private:
  /// A parent with its blocks: what there is to choose.
  struct Choices {
    double best = 0;  // log-weight
    ScratchVector<int> components;
    ScratchVector<Block*> blocks;
    ScratchVector<int> leaf_of;  // in its best association, once that has been asked for
  };
  static constexpr int kNothing = -1;
  /// A parent's association: the choices of another node, but for one later block.
  struct Node {
    double log_weight;
    int parent;
    int block = kNothing;  // of the parent; the best association of a parent changes none
    int rank = 0;          // of its ranking
    int rest = kNothing;   // the node that has the other choices; none: all others are best
  };
  struct Entry {
    double log_weight;
    int node;  // in order of creation: breaks ties
    bool operator<(const Entry& other) const {
      return log_weight != other.log_weight ? log_weight < other.log_weight : node > other.node;
    }
  };
  void start();
  void push(const Node& node);
  void push_change(int rest, int block, int rank, double log_weight, int parent);
  void push_children(int node);
  int pop();
  Association association_of(int node);

  const AssociationProblem& problem_;
  double log_least_;
  double reach_;  // below the best: what has been ranked
  double best_ = kLogZero;
  std::size_t given_ = 0;
  Components components_;
  ScratchVector<Choices> choices_;  // per parent
  ScratchVector<Node> nodes_;
  ScratchVector<Entry> heap_;
};

}  // namespace anchord
