#include "geometry/grid.h"

#include <gtest/gtest.h>

#include <limits>

namespace anchord {
namespace {

TEST(Grid, CoversTheBoxWithTheFewestCells) {
  const Grid grid = Grid::over({0, 0, 0}, {10, 8, 3}, 0.25);
  EXPECT_EQ(grid.columns, 40);
  EXPECT_EQ(grid.rows, 32);
  EXPECT_EQ(Grid::over({0, 0, 0}, {10.01, 8, 3}, 0.25).columns, 41);
  // 0.3 / 0.1 is 2.9999999999999996 and 0.7 / 0.1 is 6.999999999999999 in binary.
  EXPECT_EQ(Grid::over({0, 0, 0}, {0.3, 0.7, 0}, 0.1).columns, 3);
  EXPECT_EQ(Grid::over({0, 0, 0}, {0.3, 0.7, 0}, 0.1).rows, 7);
}

TEST(Grid, EveryCellHoldsItsCentre) {
  const Grid grid = Grid::over({-2, 1, 0}, {1.1, 2, 3}, 0.3);
  for (int cell = 0; cell < grid.size(); ++cell) {
    const Eigen::Vector3d centre = (grid.corner_min(cell) + grid.corner_max(cell)) / 2;
    EXPECT_EQ(grid.index(centre), cell);
    EXPECT_EQ(grid.corner_min(cell).z(), 0);
    EXPECT_EQ(grid.corner_max(cell).z(), 3);
  }
}

TEST(Grid, EdgesBelongToTheGridAndOutsideIsNone) {
  const Grid grid = Grid::over({0, 0, 0}, {2, 1, 1}, 0.5);
  EXPECT_EQ(grid.index({0, 0, 0}), 0);
  EXPECT_EQ(grid.index({2, 1, 0}), grid.size() - 1);
  EXPECT_EQ(grid.index({0.6, 0.1, 99}), 1);
  EXPECT_EQ(grid.index({-0.01, 0.5, 0}), -1);
  EXPECT_EQ(grid.index({2.01, 0.5, 0}), -1);
  EXPECT_EQ(grid.index({1, -1e9, 0}), -1);
  EXPECT_EQ(grid.index({1e300, 0.5, 0}), -1);
  EXPECT_EQ(grid.index({std::numeric_limits<double>::quiet_NaN(), 0.5, 0}), -1);
}

}  // namespace
}  // namespace anchord
