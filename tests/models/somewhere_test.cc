#include "models/somewhere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>

#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Sums over some hundred cells.
constexpr double kRounding = 1e-12;
constexpr double kCell = 0.25;

/// A place of 8 x 6 cells along the cells' edges, 1 m high.
std::shared_ptr<const Footprint> table(int dims) {
  const Grid world = Grid::over(Eigen::Vector3d::Zero(), {4, 4, 3}, kCell);
  return std::make_shared<const Footprint>(
      Footprint::of(box({0.5, 1, 0.5}, {2.5, 2.5, 1.5}), world, dims));
}

CellShares random_view(Dice& dice, const Footprint& place) {
  std::vector<double> visible(place.cells.size());
  for (double& v : visible) v = dice.chance(0.3) ? dice.uniform(0, 1) : dice.chance(0.5) ? 1 : 0;
  return {visible, place};
}

double total(const Somewhere& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.footprint()->cells.size(); ++i)
    sum += s.mass_in(static_cast<int>(i));
  return sum;
}

std::vector<double> masses(const Somewhere& s) {
  std::vector<double> out;
  for (std::size_t i = 0; i < s.footprint()->cells.size(); ++i)
    out.push_back(s.mass_in(static_cast<int>(i)));
  return out;
}

class SomewhereIn : public testing::TestWithParam<int> {
 protected:
  const int dims = GetParam();
  const std::shared_ptr<const Footprint> place = table(dims);
  std::mt19937_64 random{3};
  Dice dice{random};

  /// Looked at a few times, with something entered since.
  Somewhere looked_at() {
    Somewhere s(place);
    for (int i = 0; i < 4; ++i) {
      s.miss(dice.uniform(0.1, 0.9), random_view(dice, *place));
      s.enter(dice.uniform(0.1, 1), dice.uniform(0.01, 0.1));
    }
    return s;
  }
};
INSTANTIATE_TEST_SUITE_P(Dimensions, SomewhereIn, testing::Values(2, 3));

TEST_P(SomewhereIn, MassStaysOneAfterAnySequence) {
  for (int sequence = 0; sequence < 20; ++sequence) {
    Somewhere s(place), other = looked_at();
    for (int step = 0; step < 1000; ++step) {
      switch (dice.integer(0, 3)) {
        case 0:
          s.enter(dice.uniform(0, 1), dice.scale(1e-9, 1));
          break;
        case 1:
          s = Somewhere::merge(dice.scale(1e-6, 1), s, dice.scale(1e-6, 1), other);
          break;
        default:
          s.miss(dice.uniform(0, 0.999), random_view(dice, *place));
      }
      ASSERT_NEAR(total(s), 1, 1e-10) << "a thousand normalisations";
      for (const double m : masses(s)) ASSERT_GE(m, 0);
    }
  }
}

TEST_P(SomewhereIn, MassStaysOneWhereAllIsSeenAgainAndAgain) {
  Somewhere s = looked_at();
  const std::vector<double> before = masses(s);
  const CellShares all(std::vector<double>(before.size(), 1.0), *place);
  for (int i = 0; i < 1000; ++i) s.miss(0.9, all);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(s.mass_in(static_cast<int>(i)), before[i], kRounding);
}

TEST_P(SomewhereIn, StartsUniformAndIsNothingOutside) {
  const Somewhere s(place);
  const double volume = 2 * 1.5 * 1;
  EXPECT_NEAR(s.density({1, 2, 1}), 1 / volume, kRounding);
  EXPECT_EQ(s.density({0.49, 2, 1}), 0);
  EXPECT_EQ(s.density({1, 2.51, 1}), 0);
  EXPECT_EQ(s.density({1, 2, 1.6}) == 0, dims == 3);
}

TEST_P(SomewhereIn, DensityIsAMassPerVolumeOfItsCell) {
  const Somewhere s = looked_at();
  const double volume = kCell * kCell * 1;
  for (std::size_t i = 0; i < place->cells.size(); ++i) {
    Eigen::Vector3d x = place->grid.corner_min(place->cells[i]);
    x += Eigen::Vector3d(0.1, 0.2, 0.5);
    EXPECT_NEAR(s.density(x) * volume, s.mass_in(static_cast<int>(i)), kRounding);
  }
}

TEST_P(SomewhereIn, MissIsBayesOnTheCells) {
  for (int n = 0; n < 50; ++n) {
    Somewhere s = looked_at();
    std::vector<double> expected = masses(s);
    const auto visible = random_view(dice, *place);
    const double p = dice.uniform(0, 0.99);
    double seen = 0, sum = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      seen += expected[i] * visible[i];
      sum += expected[i] *= 1 - p * visible[i];
    }
    EXPECT_NEAR(s.mass(visible), seen, kRounding);
    s.miss(p, visible);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(s.mass_in(static_cast<int>(i)), expected[i] / sum, kRounding);
  }
}

TEST_P(SomewhereIn, EnterIsTheMixtureWithTheUniform) {
  for (int n = 0; n < 50; ++n) {
    Somewhere s = looked_at();
    const std::vector<double> before = masses(s);
    const double weight = dice.uniform(0, 1), entering = dice.scale(1e-6, 1);
    s.enter(weight, entering);
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(s.mass_in(static_cast<int>(i)),
                  (weight * before[i] + entering * place->share[i]) / (weight + entering),
                  kRounding);
  }
}

TEST_P(SomewhereIn, WhatEntersAnEmptyModelIsUniform) {
  Somewhere s = looked_at();
  s.enter(0, 0.1);
  EXPECT_EQ(masses(s), masses(Somewhere(place)));
}

TEST_P(SomewhereIn, WhatIsStirredForgetsWhereItWasNot) {
  for (int n = 0; n < 50; ++n) {
    const Somewhere before = looked_at();
    const double first = dice.scale(1e-3, 1), second = dice.scale(1e-3, 1);
    Somewhere once = before, twice = before;
    once.stir(first + second);
    twice.stir(first);
    twice.stir(second);
    const double stays = std::exp(-first - second);
    for (int i = 0; i < static_cast<int>(place->cells.size()); ++i) {
      EXPECT_NEAR(once.mass_in(i), stays * before.mass_in(i) + (1 - stays) * place->share[i],
                  kRounding);
      EXPECT_NEAR(twice.mass_in(i), once.mass_in(i), kRounding);
    }
  }
}

TEST_P(SomewhereIn, MergeIsTheMixture) {
  for (int n = 0; n < 50; ++n) {
    const Somewhere a = looked_at(), b = looked_at();
    const double u = dice.uniform(0.01, 0.99);
    const Somewhere m = Somewhere::merge(u, a, 1 - u, b);
    for (int i = 0; i < static_cast<int>(place->cells.size()); ++i)
      EXPECT_NEAR(m.mass_in(i), u * a.mass_in(i) + (1 - u) * b.mass_in(i), kRounding);
  }
}

TEST_P(SomewhereIn, MomentsOfTheUniformAreThoseOfABox) {
  const Gaussian g = Somewhere(place).moments();
  EXPECT_NEAR(g.mean.x(), 1.5, kRounding);
  EXPECT_NEAR(g.mean.y(), 1.75, kRounding);
  EXPECT_NEAR(g.mean.z(), dims == 3 ? 1 : 0, kRounding);
  EXPECT_NEAR(g.covariance(0, 0), 4.0 / 12, kRounding);
  EXPECT_NEAR(g.covariance(1, 1), 1.5 * 1.5 / 12, kRounding);
  EXPECT_NEAR(g.covariance(2, 2), dims == 3 ? 1.0 / 12 : 0, kRounding);
  EXPECT_NEAR(g.covariance(0, 1), 0, kRounding);
}

double normal_mass(double from, double to, double mean, double variance) {
  const auto below = [&](double x) {
    return 0.5 * std::erfc((mean - x) / std::sqrt(2 * variance));
  };
  return below(to) - below(from);
}

/// The convolution with a diagonal R, cell by cell.
double convolved(const Somewhere& s, const Gaussian& z) {
  const Footprint& f = *s.footprint();
  double sum = 0;
  for (std::size_t i = 0; i < f.cells.size(); ++i) {
    const Eigen::Vector3d low = f.grid.corner_min(f.cells[i]), high = f.grid.corner_max(f.cells[i]);
    double in_cell = 1;
    for (int a = 0; a < f.dims; ++a)
      in_cell *= normal_mass(low[a], high[a], z.mean[a], z.covariance(a, a));
    sum += in_cell * s.mass_in(static_cast<int>(i)) / (kCell * kCell * 1);
  }
  return sum;
}

Gaussian random_measurement(Dice& dice, double sigma) {
  Gaussian z;
  z.mean = {dice.uniform(0, 3), dice.uniform(0.5, 3), dice.uniform(0.3, 1.7)};
  for (int i = 0; i < 3; ++i) z.covariance(i, i) = std::pow(sigma * dice.uniform(0.7, 1), 2);
  return z;
}

TEST_P(SomewhereIn, LikelihoodOfTheUniformIsTheConvolution) {
  const Somewhere s(place);
  for (int n = 0; n < 300; ++n) {
    const Gaussian z = random_measurement(dice, dice.scale(0.01, 2));
    EXPECT_NEAR(s.likelihood(z), convolved(s, z), 1e-9) << "3-D: mass() integrates over z";
  }
}

TEST_P(SomewhereIn, LikelihoodOfSmallNoiseInsideACellIsTheConvolution) {
  for (int n = 0; n < 100; ++n) {
    const Somewhere s = looked_at();
    const int i = dice.integer(0, static_cast<int>(place->cells.size()) - 1);
    Gaussian z = random_measurement(dice, kCell / 20);  // 8 sigma from the cell's edges
    z.mean = place->grid.corner_min(place->cells[i]) +
             Eigen::Vector3d(dice.uniform(0.4, 0.6) * kCell, dice.uniform(0.4, 0.6) * kCell, 0.5);
    EXPECT_NEAR(s.likelihood(z), convolved(s, z), kRounding + 1e-9);
  }
}

TEST_P(SomewhereIn, LikelihoodOfWideNoiseIsNearTheConvolution) {
  double worst = 0, sum = 0;
  constexpr int kTrials = 400;
  for (int n = 0; n < kTrials; ++n) {
    // One side of a line was in view.
    std::vector<double> visible(place->cells.size());
    const double line = dice.uniform(0.5, 2.5), p = dice.uniform(0.5, 0.95);
    for (std::size_t i = 0; i < visible.size(); ++i) {
      const double x = place->grid.corner_min(place->cells[i]).x();
      visible[i] = std::clamp((line - x) / kCell, 0.0, 1.0);
    }
    Somewhere s(place);
    s.miss(p, {visible, *place});
    const Gaussian z = random_measurement(dice, dice.scale(kCell / 2, 4 * kCell));
    const double off = std::abs(s.likelihood(z) - convolved(s, z)) * place->volume;
    worst = std::max(worst, off);
    sum += off;
  }
  // In units of the uniform density: what 5 x 5 points of equal probability make of an edge.
  EXPECT_LT(sum / kTrials, 0.03);
  EXPECT_LT(worst, 0.5);
}

}  // namespace
}  // namespace anchord
