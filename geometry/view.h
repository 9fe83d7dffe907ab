#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/frame.h"
#include "core/result.h"
#include "geometry/gaussian.h"
#include "geometry/region.h"

namespace anchord {

struct MassPrecision;

/// What a sensor could see, placed in the map: a View and a Pose (its mean). Angles are compared
/// modulo 2 pi, ranges are Euclidean from the sensor. In a 2-D world only x, y and yaw of the pose
/// and range and bearing of the view are used (of a frustum: hfov and range).
class MapView {
 public:
  /// Refuses numbers that are not finite, empty or reversed intervals, bad polygons, opening
  /// angles outside (0, pi). Without pose the view is in the map frame. Fields are named below
  /// "view".
  static Result<MapView> place(const View& view, const std::optional<Pose>& pose, int dims);

  bool sees_everything() const { return type_ == View::Type::kWorld; }
  bool sees_nothing() const { return type_ == View::Type::kNone; }

  bool contains(const Eigen::Vector3d& point_map) const;

  /// The probability that a point drawn from `density` is in view. In closed form where only
  /// planes cut the density (Owen's T); where ranges or cones do, by 1-D (2-D world) or 2-D (3-D
  /// world) adaptive quadrature over directions, closed form along each ray; polygons as mass()
  /// of gaussian_mass.h. Error below 1e-6, or about `tolerance` where that is more, at less cost.
  double mass(const Gaussian& density, double tolerance = 0) const;

  /// The share of an axis-aligned box of the map that is in view. 0 and 1 are exact; a box on the
  /// edge is sampled (error below 0.05).
  double share(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max) const;

  /// A box in the plane outside of which nothing is seen: {x_min, y_min, x_max, y_max}, map frame;
  /// infinite for kWorld, zeros for kNone.
  std::array<double, 4> bounds() const;

  bool operator==(const MapView&) const = default;

 private:
  /// How far inside a point is of each kind of limit, metres, negative outside. Each changes by at
  /// most the distance that the point moves; infinite where there is no such limit.
  struct Depth {
    double range, bearing, elevation;
    double least() const;
  };

  /// The limits that do not cut a density, and whether it is outside of one altogether.
  struct Clearance {
    bool range, bearing, elevation, outside;
  };

  Status set_sector(const View& view);
  Status set_frustum(const View& view);
  Status set_range(const View& view);
  Status set_polygon(const View& view);
  void set_bearing(double from, double width);
  std::array<double, 4> reach() const;

  Eigen::Vector3d in_sensor(const Eigen::Vector3d& point_map) const;
  double along(const Eigen::Vector3d& p) const;
  Depth depth(const Eigen::Vector3d& p) const;
  double sampled_share(const Eigen::Vector3d& box_min, const Eigen::Vector3d& size) const;
  double polygon_share(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max) const;
  Clearance clearance(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance,
                      const Depth& at_mean, double sphere, const MassPrecision& precision) const;
  double flat_mass(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                   const MassPrecision& precision) const;
  double solid_mass(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance, bool any_range,
                    const MassPrecision& precision) const;

  View::Type type_ = View::Type::kNone;
  int dims_ = 3;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();  ///< map from sensor
  double range_min_ = 0, range_max_ = 0;
  /// Bearings from the first, in [-pi, pi], on over the width, in (0, 2 pi].
  double bearing_from_ = 0, bearing_width_ = 0;
  bool all_bearings_ = false;
  std::array<Eigen::Vector3d, 2> bearing_normal_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  /// Sector: elevation angles. Frustum: the angles of its lower and upper plane in the plane y = 0.
  double elevation_min_ = 0, elevation_max_ = 0;
  bool has_floor_ = false, has_ceiling_ = false;
  Eigen::Vector2d floor_normal_ = Eigen::Vector2d::Zero();    ///< over (along(p), z)
  Eigen::Vector2d ceiling_normal_ = Eigen::Vector2d::Zero();  ///< over (along(p), z)
  Region polygon_;                                            ///< of a polygon view, map frame
  std::array<double, 4> bounds_{};
};

}  // namespace anchord
