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

 private:
  /// A parent with its blocks: what there is to choose.
  struct Choices {
    double best = 0;  // log-weight
    ScratchVector<int> components;
    ScratchVector<Block*> blocks;
  };
  /// A parent's association: for each of its blocks which one of its ranking.
  struct Node {
    double log_weight;
    int parent;
    int last;  // block that was changed last: those before stay
    SmallScratchVector<int, 8> rank;
    std::size_t number;  // in order of creation: breaks ties
    bool operator<(const Node& other) const {
      return log_weight != other.log_weight ? log_weight < other.log_weight : number > other.number;
    }
  };
  void start();
  void push(Node node);
  void push_children(const Node& node);
  bool pop(Node& node);
  Association association_of(const Node& node);

  const AssociationProblem& problem_;
  double log_least_;
  double reach_;  // below the best: what has been ranked
  double best_ = kLogZero;
  std::size_t given_ = 0, created_ = 0;
  Components components_;
  ScratchVector<Choices> choices_;  // per parent
  ScratchVector<Node> heap_;
};

}  // namespace anchord
