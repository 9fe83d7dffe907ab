#pragma once

#include <boost/container/small_vector.hpp>
#include <span>
#include <vector>

#include "core/pool.h"

namespace anchord {

/// One consistent choice of a leaf for every anchor of a cluster, with its probability: a possible
/// world, as far as the cluster goes.
struct Hypothesis {
  /// The anchor is not part of this world.
  static constexpr int kNoLeaf = -1;
  double log_weight = 0;
  /// Per anchor of the cluster.
  boost::container::small_vector<int, 12, PoolAllocator<int>> leaf;
};

/// The hypotheses of one cluster, all over the same anchors. Functions keep them best first; equal
/// weights keep their order.
using HypothesisSet = PoolVector<Hypothesis>;

/// Sorts and scales the weights so that they sum to 1. Returns ln of what they summed to.
double normalise(HypothesisSet& set);

/// Makes one of those that choose the same leaves, with the sum of their weights; normalises.
void merge_equal(HypothesisSet& set);

/// Drops all but the best `max` (0: no bound) and those below `min_weight`, never the best one.
/// The set must be normalised, and is again. Returns the probability that was dropped.
double prune(HypothesisSet& set, int max, double min_weight);

/// The product of two independent clusters, anchors of `a` first: its best `max` hypotheses (0:
/// all) of at least `min_weight`, best first, found without forming the others. Normalised. Adds
/// the probability of the others to `dropped`.
HypothesisSet join(const HypothesisSet& a, const HypothesisSet& b, int max, double min_weight,
                   double* dropped = nullptr);

/// What a set says about some of its anchors: their joint distribution, normalised.
HypothesisSet marginal(const HypothesisSet& set, std::span<const int> anchors);

}  // namespace anchord
