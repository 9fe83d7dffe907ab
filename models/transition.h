#pragma once

#include <Eigen/Core>

namespace anchord {

/// Square matrix over a class's behaviour models.
using ModelMatrix = Eigen::MatrixXd;

/// The transition probabilities of a continuous-time Markov chain after dt seconds: exp(rates dt).
/// rates(i, j), i != j, is the rate (1/s, >= 0) from i to j; the diagonal is not looked at. Rows of
/// the result sum to 1. Chains of which every path has one step (what `somewhere` models make) and
/// those of two states are solved in closed form, others by scaling and squaring a Taylor series.
ModelMatrix transition_probabilities(const ModelMatrix& rates, double dt);

/// The same for up to so many models, without asking for memory.
inline constexpr int kFewModels = 4;
using FewModelsMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kFewModels, kFewModels>;
FewModelsMatrix transition_probabilities(const FewModelsMatrix& rates, double dt);

}  // namespace anchord
