#pragma once

#include <Eigen/Core>

namespace anchord {

/// Square matrix over a class's behaviour models.
using ModelMatrix = Eigen::MatrixXd;

/// The transition probabilities of a continuous-time Markov chain after dt seconds: exp(rates dt).
/// rates(i, j), i != j, is the rate (1/s, >= 0) from i to j; the diagonal is not looked at. Rows of
/// the result sum to 1. Chains of which every path has one step (what `somewhere` models make)
/// are solved in closed form, others by scaling and squaring a Taylor series.
ModelMatrix transition_probabilities(const ModelMatrix& rates, double dt);

}  // namespace anchord
