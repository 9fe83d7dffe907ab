#include "models/relative_heights.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "models/somewhere.h"
#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

constexpr double kRounding = 1e-12;

/// A place of 5 x 4 m, 20 x 16 cells: three by two blocks of them.
std::shared_ptr<const Footprint> hall() {
  const Grid world = Grid::over(Eigen::Vector3d::Zero(), {8, 8, 3}, 0.25);
  return std::make_shared<const Footprint>(Footprint::of(box({1, 1, 0}, {6, 5, 3}), world, 3));
}

/// What is in view of a rectangle of the hall's cells, the rest is not.
CellShares part_in_view(Dice& dice, const Footprint& place) {
  const double x = dice.uniform(1, 6), y = dice.uniform(1, 5);
  std::vector<double> shares(place.cells.size(), 0.0);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Vector3d at = place.moments[i].mean;
    if (at.x() > x && at.x() < x + 2 && at.y() > y && at.y() < y + 1.5)
      shares[i] = dice.chance(0.5) ? 1 : dice.uniform(0, 1);
  }
  return {shares, place};
}

/// A density and, for comparison, its masses cell by cell.
struct Compared {
  Somewhere density;
  std::vector<double> mass;

  explicit Compared(std::shared_ptr<const Footprint> place) : density(place), mass(place->share) {}

  void enter(double weight, double entering) {
    density.enter(weight, entering);
    const auto& share = density.footprint()->share;
    for (std::size_t i = 0; i < mass.size(); ++i)
      mass[i] = (weight * mass[i] + entering * share[i]) / (weight + entering);
  }
  void miss(double p, const CellShares& visible) {
    density.miss(p, visible);
    double sum = 0;
    for (std::size_t i = 0; i < mass.size(); ++i) sum += mass[i] *= 1 - p * visible[i];
    for (double& m : mass) m /= sum;
  }
  void merge(double weight, double other_weight, const Compared& other) {
    density = Somewhere::merge(weight, density, other_weight, other.density);
    for (std::size_t i = 0; i < mass.size(); ++i)
      mass[i] = (weight * mass[i] + other_weight * other.mass[i]) / (weight + other_weight);
  }
};

TEST(RelativeHeights, AreThoseOfEachCellByItselfWhateverHappens) {
  const auto place = hall();
  ASSERT_EQ(place->blocks(), 6);
  std::mt19937_64 random(11);
  Dice dice(random);
  for (int scene = 0; scene < 30; ++scene) {
    std::vector<Compared> all(3, Compared(place));
    for (int step = 0; step < 60; ++step) {
      Compared& one = all[static_cast<std::size_t>(dice.uniform(0, 3))];
      const Compared& other = all[static_cast<std::size_t>(dice.uniform(0, 3))];
      if (dice.chance(0.5))
        one.miss(dice.uniform(0, 0.95), part_in_view(dice, *place));
      else if (dice.chance(0.6))
        one.enter(dice.uniform(0.1, 1), dice.scale(1e-6, 1));
      else
        one.merge(dice.uniform(0.1, 1), dice.uniform(0.1, 1), other);
      const CellShares asked = part_in_view(dice, *place);
      double mass = 0;
      for (std::size_t i = 0; i < one.mass.size(); ++i) {
        ASSERT_NEAR(one.density.mass_in(static_cast<int>(i)), one.mass[i], kRounding);
        mass += asked[i] * one.mass[i];
      }
      ASSERT_NEAR(one.density.mass(asked), mass, kRounding);
    }
  }
}

TEST(RelativeHeights, FitTheFootprintTheyAreOver) {
  const auto place = hall();
  const Grid world = Grid::over(Eigen::Vector3d::Zero(), {8, 8, 3}, 0.25);
  const Footprint other = Footprint::of(box({1, 1, 0}, {2, 2, 3}), world, 3);
  EXPECT_TRUE(RelativeHeights(*place).fits(*place));
  EXPECT_FALSE(RelativeHeights(*place).fits(other));
}

}  // namespace
}  // namespace anchord
