#pragma once

#include <Eigen/Core>
#include <span>

#include "anchoring/belief.h"
#include "anchoring/reading.h"

namespace anchord {

/// Entropies in nat (thesis section 3.5.1). Differential ones (of positions, metres) may be
/// negative, and minus infinity for a density without width.

/// -sum p ln p; 0 ln 0 = 0. The probabilities sum to 1.
double discrete_entropy(std::span<const double> probabilities);
/// Of an event with probability p.
double binary_entropy(double p);
/// Thesis (3.3): d/2 (1 + ln 2 pi) + 1/2 ln |covariance|, over the leading `dims` axes.
double gaussian_entropy(const Eigen::Matrix3d& covariance, int dims);

/// An upper bound of the entropy of a leaf's density over position: the lesser of
/// - sum of w_m (H_m - ln w_m): the entropy of position and model together (M. F. Huber et al.,
///   "On entropy approximation for Gaussian mixture random variables", MFI 2008, theorem 3), exact
///   where the models do not overlap;
/// - the Gaussian of equal moments, which has the most entropy of all densities with them.
/// The entropy of a `somewhere` alone is exact.
double position_entropy(const Leaf& leaf, int dims);

/// The same over all leaves of an object, given that it exists.
double position_entropy(const ObjectBelief& object, const Background& background);

/// Of the class, given that it exists (over all leaves).
double class_entropy(const ObjectBelief& object, const Background& background);

/// Of the other attributes, given that it exists: the leaves' entropies in the mean, symbols in nat
/// and scalars as Gaussians over their own unit. Attributes that a leaf does not hold count 0.
double attribute_entropy(const ObjectBelief& object);

/// H_b(p) + p (H_position + H_class + H_attributes): what is not known about an object.
double entropy(const ObjectBelief& object, const Background& background);

/// Over all anchors with p >= min_p at time `at`: thesis (3.13) and (3.14).
struct BeliefEntropy {
  double sum = 0;
  double max = 0;  ///< minus infinity where there are no anchors
  int objects = 0;
};
BeliefEntropy entropy(const Belief& belief, Utime at, double min_p, const Background& background);

}  // namespace anchord
