#include "models/transition.h"

#include <cmath>

namespace anchord {
namespace {

/// True where no model that is entered can be left: then each row is a single exponential race.
template <typename Matrix>
bool single_step(const Matrix& rates) {
  for (int i = 0; i < rates.rows(); ++i)
    for (int j = 0; j < rates.cols(); ++j)
      if (i != j && rates(i, j) > 0)
        for (int k = 0; k < rates.cols(); ++k)
          if (k != j && rates(j, k) > 0) return false;
  return true;
}

template <typename Matrix>
Matrix probabilities(const Matrix& rates, double dt) {
  const int n = static_cast<int>(rates.rows());
  Matrix q = rates * dt;
  for (int i = 0; i < n; ++i) {
    q(i, i) = 0;
    q(i, i) = -q.row(i).sum();
  }
  if (n == 2) {
    const double total = -q(0, 0) - q(1, 1);
    const Matrix p = Matrix::Identity(2, 2);
    return total > 0 ? Matrix(p - q * (std::expm1(-total) / total)) : p;
  }
  if (single_step(rates)) {
    Matrix p = Matrix::Identity(n, n);
    for (int i = 0; i < n; ++i) {
      if (q(i, i) == 0) continue;
      const double leave = -std::expm1(q(i, i)) / -q(i, i);
      for (int j = 0; j < n; ++j) p(i, j) = i == j ? std::exp(q(i, i)) : q(i, j) * leave;
    }
    return p;
  }
  // |q| <= 1/16 after scaling: 12 terms leave a remainder below 1e-24.
  const double size = q.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = size > 0.0625 ? static_cast<int>(std::ceil(std::log2(size / 0.0625))) : 0;
  const Matrix a = q * std::ldexp(1.0, -squarings);
  Matrix p = Matrix::Identity(n, n), term = p;
  for (int k = 1; k <= 12; ++k) p += (term = term * a / k);
  for (int s = 0; s < squarings; ++s) p = p * p;
  p = p.cwiseMax(0.0);
  for (int i = 0; i < n; ++i) p.row(i) /= p.row(i).sum();  // squaring loses a few ulps
  return p;
}

}  // namespace

ModelMatrix transition_probabilities(const ModelMatrix& rates, double dt) {
  return probabilities(rates, dt);
}

FewModelsMatrix transition_probabilities(const FewModelsMatrix& rates, double dt) {
  return probabilities(rates, dt);
}

}  // namespace anchord
