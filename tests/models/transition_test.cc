#include "models/transition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Some squarings of a matrix of probabilities, each losing a few ulps.
constexpr double kRounding = 1e-12;

ModelMatrix random_rates(Dice& dice, int n) {
  ModelMatrix rates = ModelMatrix::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (i != j && dice.chance(0.6)) rates(i, j) = dice.scale(1e-4, 10);
  return rates;
}

/// Models below `sinks` are never left, and only they are entered.
ModelMatrix random_single_step(Dice& dice, int n, int sinks) {
  ModelMatrix rates = ModelMatrix::Zero(n, n);
  for (int i = sinks; i < n; ++i)
    for (int j = 0; j < sinks; ++j) rates(i, j) = dice.scale(1e-4, 10);
  return rates;
}

ModelMatrix generator(const ModelMatrix& rates) {
  ModelMatrix q = rates;
  q.diagonal().setZero();
  q.diagonal() = -q.rowwise().sum();
  return q;
}

TEST(TransitionProbabilities, EqualTheMatrixExponential) {
  std::mt19937_64 random(1);
  Dice dice(random);
  for (int n = 0; n < 300; ++n) {
    const int models = dice.integer(1, 5);
    const ModelMatrix rates = dice.chance(0.5)
                                  ? random_rates(dice, models)
                                  : random_single_step(dice, models, dice.integer(0, models));
    const double dt = dice.scale(1e-4, 10);
    const ModelMatrix expected = (generator(rates) * dt).exp();
    EXPECT_LT((transition_probabilities(rates, dt) - expected).cwiseAbs().maxCoeff(), kRounding)
        << rates << "\n"
        << dt;
  }
}

TEST(TransitionProbabilities, RowsAreDistributions) {
  std::mt19937_64 random(2);
  Dice dice(random);
  for (int n = 0; n < 300; ++n) {
    const ModelMatrix p =
        transition_probabilities(random_rates(dice, dice.integer(1, 5)), dice.scale(1e-6, 1e8));
    EXPECT_GE(p.minCoeff(), 0);
    EXPECT_LT((p.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-14) << "a few ulps";
  }
}

TEST(TransitionProbabilities, FormASemigroup) {
  std::mt19937_64 random(3);
  Dice dice(random);
  for (int n = 0; n < 300; ++n) {
    const ModelMatrix rates =
        dice.chance(0.5) ? random_rates(dice, 4) : random_single_step(dice, 4, dice.integer(1, 3));
    const double s = dice.scale(1e-3, 1e2), t = dice.scale(1e-3, 1e2);
    const ModelMatrix product =
        transition_probabilities(rates, s) * transition_probabilities(rates, t);
    EXPECT_LT((product - transition_probabilities(rates, s + t)).cwiseAbs().maxCoeff(), kRounding);
  }
}

TEST(TransitionProbabilities, ClosedFormEqualsTheSeries) {
  std::mt19937_64 random(4);
  Dice dice(random);
  for (int n = 0; n < 200; ++n) {
    const ModelMatrix rates = random_single_step(dice, 4, 2);
    ModelMatrix leaves_a_sink = rates;
    leaves_a_sink(0, 3) = 1e-300;  // no probability that a double holds, but no single step either
    const double dt = dice.scale(1e-4, 1e3);
    EXPECT_LT((transition_probabilities(rates, dt) - transition_probabilities(leaves_a_sink, dt))
                  .cwiseAbs()
                  .maxCoeff(),
              kRounding);
  }
}

TEST(TransitionProbabilities, TheDiagonalOfTheRatesIsNotLookedAt) {
  ModelMatrix rates(2, 2), filled(2, 2);
  rates << 0, 0.5, 0.25, 0;
  filled << -7, 0.5, 0.25, 1e9;
  EXPECT_EQ(transition_probabilities(rates, 2), transition_probabilities(filled, 2));
}

TEST(TransitionProbabilities, NoTimeOrNoRatesChangeNothing) {
  ModelMatrix rates(2, 2);
  rates << 0, 0.5, 0.25, 0;
  EXPECT_TRUE(transition_probabilities(rates, 0).isIdentity(0));
  EXPECT_TRUE(transition_probabilities(ModelMatrix(ModelMatrix::Zero(3, 3)), 5).isIdentity(0));
}

TEST(TransitionProbabilities, OfFewModelsAreTheSame) {
  std::mt19937_64 random(5);
  Dice dice(random);
  for (int n = 1; n <= kFewModels; ++n) {
    ModelMatrix rates(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) rates(i, j) = dice.uniform(0, 2);
    EXPECT_EQ(ModelMatrix(transition_probabilities(FewModelsMatrix(rates), 0.7)),
              transition_probabilities(rates, 0.7));
  }
}

TEST(TransitionProbabilities, TwoModelsInClosedForm) {
  // dw/dt = -a w + b (1 - w): w(t) = b/(a+b) + (w(0) - b/(a+b)) exp(-(a+b) t).
  const double a = 0.2, b = 0.05;
  ModelMatrix rates(2, 2);
  rates << 0, a, b, 0;
  for (const double t : {0.01, 1.0, 30.0, 1e4}) {
    const ModelMatrix p = transition_probabilities(rates, t);
    const double decay = std::exp(-(a + b) * t);
    EXPECT_NEAR(p(0, 0), b / (a + b) + a / (a + b) * decay, kRounding);
    EXPECT_NEAR(p(1, 0), b / (a + b) - b / (a + b) * decay, kRounding);
  }
}

}  // namespace
}  // namespace anchord
