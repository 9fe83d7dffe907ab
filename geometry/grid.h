#pragma once

#include <Eigen/Core>

namespace anchord {

/// A grid of square columns over a box of the map. Cells are numbered row by row, x fastest.
/// In a 3-D world a cell is a column from the box's floor to its ceiling.
struct Grid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< corner of cell 0, m
  double cell = 0.25;                                ///< edge of a cell, m
  int columns = 0, rows = 0;
  double z_min = 0, z_max = 0;

  /// The least grid of that cell size that covers the box.
  static Grid over(const Eigen::Vector3d& min, const Eigen::Vector3d& max, double cell);

  bool operator==(const Grid&) const = default;
  int size() const { return columns * rows; }
  /// The cell over or under a point, or -1 outside the grid (the height is not looked at).
  int index(const Eigen::Vector3d& point) const;
  /// Lower and upper corner of a cell.
  Eigen::Vector3d corner_min(int cell_index) const;
  Eigen::Vector3d corner_max(int cell_index) const;
};

}  // namespace anchord
