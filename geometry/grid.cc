#include "geometry/grid.h"

#include <algorithm>
#include <cmath>

namespace anchord {
namespace {

/// Cells that cover a length; one that ends on a cell's edge to within rounding gets no more.
int cells_over(double length, double cell) {
  return std::max(1, static_cast<int>(std::ceil(length / cell * (1 - 1e-12))));
}

/// The cell along one axis, or -1. The grid's far edge belongs to its last cell.
int along(double offset, double cell, int count) {
  const double position = offset / cell;
  if (!(position >= 0 && position <= count)) return -1;
  return std::min(static_cast<int>(position), count - 1);
}

}  // namespace

Grid Grid::over(const Eigen::Vector3d& min, const Eigen::Vector3d& max, double cell) {
  Grid grid;
  grid.origin = min;
  grid.cell = cell;
  grid.columns = cells_over(max.x() - min.x(), cell);
  grid.rows = cells_over(max.y() - min.y(), cell);
  grid.z_min = min.z();
  grid.z_max = max.z();
  return grid;
}

int Grid::index(const Eigen::Vector3d& point) const {
  const int column = along(point.x() - origin.x(), cell, columns);
  const int row = along(point.y() - origin.y(), cell, rows);
  return column < 0 || row < 0 ? -1 : row * columns + column;
}

Eigen::Vector3d Grid::corner_min(int cell_index) const {
  return {origin.x() + cell * (cell_index % columns), origin.y() + cell * (cell_index / columns),
          z_min};
}

Eigen::Vector3d Grid::corner_max(int cell_index) const {
  return {origin.x() + cell * (cell_index % columns + 1),
          origin.y() + cell * (cell_index / columns + 1), z_max};
}

}  // namespace anchord
