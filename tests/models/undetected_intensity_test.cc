#include "models/undetected_intensity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "tests/anchoring/dice.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// More than one tile each way, none of them full.
const Grid kGrid = Grid::over(Eigen::Vector3d::Zero(), {9, 5, 1}, 0.25);

/// d lambda / dt = beta - mu lambda over dt, by Runge and Kutta's fourth-order steps.
double integrated(double lambda, double beta, double mu, double dt) {
  constexpr int kSteps = 200;  // mu h < 0.05: an error of about h^4 = 1e-9 of what changes, or less
  const double h = dt / kSteps;
  const auto slope = [&](double x) { return beta - mu * x; };
  for (int i = 0; i < kSteps; ++i) {
    const double a = slope(lambda), b = slope(lambda + h / 2 * a), c = slope(lambda + h / 2 * b),
                 d = slope(lambda + h * c);
    lambda += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return lambda;
}

struct Scene {
  std::shared_ptr<const Tiling> tiling = std::make_shared<const Tiling>(kGrid);
  std::shared_ptr<const ArrivalModel> model;
  UndetectedIntensity intensity;
  Scene(double start, double mu, double beta, std::vector<double> per_cell)
      : model(std::make_shared<const ArrivalModel>(
            ArrivalModel{start, mu, beta, std::move(per_cell)})),
        intensity(tiling, model) {}

  /// A look with the given share of each cell.
  Look look(const std::vector<double>& share) const {
    Look out;
    for (int t = 0; t < tiling->tiles(); ++t) {
      Look::Tile tile{t, std::vector<double>(Tiling::kCells, 0.0)};
      bool any = false;
      for (int cell = 0; cell < kGrid.size(); ++cell)
        if (tiling->tile_of(cell) == t) {
          tile.share[tiling->place_in_tile(cell)] = share[cell];
          any = any || share[cell] > 0;
        }
      if (any) out.tiles.push_back(std::move(tile));
    }
    return out;
  }
};

Scene random_scene(Dice& dice) {
  std::vector<double> per_cell;
  if (dice.chance(0.5))
    for (int i = 0; i < kGrid.size(); ++i) per_cell.push_back(dice.scale(1e-4, 0.1));
  return Scene(dice.scale(1e-3, 1), dice.chance(0.3) ? 0 : dice.scale(1e-3, 0.5),
               dice.scale(1e-4, 0.1), std::move(per_cell));
}

TEST(UndetectedIntensity, EqualsDirectIntegrationOfEveryCell) {
  std::mt19937_64 random(6);
  Dice dice(random);
  for (int n = 0; n < 20; ++n) {
    Scene scene = random_scene(dice);
    const ArrivalModel& model = *scene.model;
    std::vector<double> expected(kGrid.size(), model.start);
    double time = 0;
    const auto pass = [&](double dt) {
      for (int i = 0; i < kGrid.size(); ++i)
        expected[i] =
            integrated(expected[i],
                       model.arrival_rate_per_cell.empty() ? model.arrival_rate
                                                           : model.arrival_rate_per_cell[i],
                       model.departure_rate, dt);
      time += dt;
    };
    for (int frame = 0; frame < 12; ++frame) {
      pass(dice.chance(0.2) ? 0 : dice.scale(0.01, 10));
      std::vector<double> share(kGrid.size(), 0.0);
      const int from = dice.integer(0, kGrid.columns - 1), to = dice.integer(from, kGrid.columns);
      for (int i = 0; i < kGrid.size(); ++i)
        if (i % kGrid.columns >= from && i % kGrid.columns < to)
          share[i] = dice.chance(0.5) ? 1 : dice.uniform(0, 1);
      const double p = dice.chance(0.1) ? 0 : dice.uniform(0, 0.99);
      scene.intensity.miss(scene.look(share), p, time);
      for (int i = 0; i < kGrid.size(); ++i) expected[i] *= 1 - p * share[i];
    }
    pass(3);
    for (int i = 0; i < kGrid.size(); ++i)
      ASSERT_NEAR(scene.intensity.at(i, time), expected[i], 1e-9 * (1 + expected[i])) << i;
  }
}

TEST(UndetectedIntensity, BeyondTheGridItKeepsItsStartValue) {
  Scene scene(0.3, 0.1, 0.02, {});
  scene.intensity.miss(scene.look(std::vector<double>(kGrid.size(), 1.0)), 0.9, 2);
  EXPECT_EQ(scene.intensity.at(-1, 100), 0.3);
}

TEST(UndetectedIntensity, TendsToArrivalsOverDepartures) {
  const Scene scene(0.3, 0.1, 0.02, {});
  EXPECT_NEAR(scene.intensity.at(5, 1e4), 0.2, 1e-15);
}

TEST(UndetectedIntensity, CopiesDoNotShareChanges) {
  Scene scene(0.3, 0.1, 0.02, {});
  const Look look = scene.look(std::vector<double>(kGrid.size(), 1.0));
  scene.intensity.miss(look, 0.5, 1);
  const UndetectedIntensity before = scene.intensity;
  const double then = before.at(7, 3);
  scene.intensity.miss(look, 0.5, 2);
  EXPECT_EQ(before.at(7, 3), then);
  EXPECT_LT(scene.intensity.at(7, 3), then);
}

TEST(Tiling, EveryCellHasAPlaceOfItsOwn) {
  const Tiling tiling(kGrid);
  std::vector<char> taken(tiling.tiles() * Tiling::kCells, 0);
  for (int cell = 0; cell < kGrid.size(); ++cell) {
    ASSERT_LT(tiling.tile_of(cell), tiling.tiles());
    ASSERT_LT(tiling.place_in_tile(cell), Tiling::kCells);
    char& place = taken[tiling.tile_of(cell) * Tiling::kCells + tiling.place_in_tile(cell)];
    EXPECT_EQ(place, 0);
    place = 1;
  }
}

}  // namespace
}  // namespace anchord
