#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame.h"
#include "core/result.h"
#include "geometry/gaussian.h"
#include "perception/placement.h"
#include "perception/roi_mask.h"

namespace anchord {

/// What the error of a carried camera's pose does to what is seen through it. A camera whose true
/// pose differs from the one that is given by dp and a small rotation dr about the map's axes shows
/// what is at X where the given pose has X - dp - dr x (X - p), to first order.

/// Refuses what check_pose() does, and places and variances that are absurd (farther than 1e6 m; a
/// direction that is not known within a radian). Fields are named below "pose".
Status check_camera_pose(const Pose& pose);

/// A position that was measured in a picture, as a frame with the picture's pose reports it: in the
/// frame that to_map() starts from, without the error of the pose, which to_map() adds.
/// `measured`: map frame, with the picture's noise alone. `height`: m above the ground of what was
/// measured, in a 2-D world.
///
/// In a 3-D world that is the sensor frame: what is measured along a pixel's ray does not depend on
/// the pose. In a 2-D world to_map() knows x, y and yaw of a pose and turns by its heading alone,
/// so the position is given in the level frame of that heading. It comes from the camera's height
/// and tilt, too; their variance, and covariance with x, y and yaw, is therefore part of the
/// measurement's. (Where the covariance would make the whole surer than without, it is not used.)
Gaussian in_sensor_frame(const Gaussian& measured, double height, const Pose& pose, int dims);

/// Whether height and tilt of the pose place what is seen at a point by the ground's plane: within
/// a fifth of its distance (standard deviation), up to where one may speak of first order.
bool ground_is_known(const Eigen::Vector3d& point, const Pose& pose);

/// Where what is at the places may appear to be: each place becomes several with the mean and the
/// covariance that the pose's error gives. In a 2-D world places whose ground is not known are left
/// out, and the weights sum to less than 1.
std::vector<Placement> apparent_places(const std::vector<Placement>& places, const Pose& pose,
                                       int dims);

/// The body with room on all sides for the pose's error (95 %) at any of the places.
Body apparent_body(Body body, const std::vector<Placement>& places, const Pose& pose);

}  // namespace anchord
