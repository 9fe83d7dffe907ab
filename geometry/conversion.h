#pragma once

#include <optional>

#include "core/frame.h"
#include "core/result.h"
#include "geometry/gaussian.h"

namespace anchord {

/// A measurement with its noise, carried from the sensor into the map frame as an unbiased mean
/// and a consistent covariance. Uncertain heading and bearing are converted exactly (UCM: Longbin,
/// Xiaoquan, Yiyu, Kang, Bar-Shalom, "Unbiased converted measurements for tracking", IEEE T-AES
/// 34(3), 1998; thesis section 6.5), elevation likewise, roll, pitch and the pose's cross terms to
/// second order. Without pose the map frame is the sensor frame.
/// A 2-D world takes range and bearing of a polar measurement and x, y and yaw of the pose.
/// Refuses: numbers that are not finite; a wrong count of numbers for `dims`; a covariance that is
/// not symmetric positive definite; a variance or range that is not positive; angles too
/// uncertain to leave a positive definite covariance in the map; a pose whose
/// quaternion's norm is off 1 by more than 1 % or whose covariance is not positive semidefinite.
/// Fields are named relative to the detection ("covariance", "polar.variance") or "pose.".
Result<Gaussian> to_map(const CartesianMeasurement& measurement, const std::optional<Pose>& pose,
                        int dims);
Result<Gaussian> to_map(const PolarMeasurement& measurement, const std::optional<Pose>& pose,
                        int dims);

/// Checks a pose alone; see to_map().
Status check_pose(const Pose& pose);

/// An angle about the sensor's z axis as one about the map's z axis, in (-pi, pi].
double yaw_in_map(double yaw, const std::optional<Pose>& pose);

}  // namespace anchord
