#pragma once

#include <Eigen/Core>

#include "geometry/ray_mass.h"

namespace anchord {

/// A half-plane that holds the sensor's z axis, with what a view's limits and a density are in it:
/// its points are (outward, up), m, outward >= 0.
struct HalfPlane {
  Eigen::Matrix2d unfold;     ///< upper triangular: white coordinates p to (outward, up)
  Eigen::Vector2d mean;       ///< the density there is exp(-|p - mean|^2 / 2)
  Eigen::Vector2d low, high;  ///< directions of the limits of elevation, outward >= 0
  double range_min, range_max;

  /// The integral over what is in view of outward exp(-|p - mean|^2 / 2) dp. `any_range`: ranges do
  /// not cut.
  double moment(bool any_range, const MassPrecision& precision, double tolerance) const;

 private:
  double between_rays(double first, double second) const;
  double at_height(double white_height) const;
  bool changes_slowly(const MassPrecision& precision) const;
  double direction_of(const Eigen::Vector2d& direction) const;
};

}  // namespace anchord
