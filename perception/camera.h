#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/frame.h"

namespace anchord {

/// The numbers of a calibrated camera: R. Y. Tsai, "A versatile camera calibration technique for
/// high-accuracy 3D machine vision metrology", IEEE J. Robotics and Automation 3(4), 1987, with
/// one radial coefficient. World in metres (translation too), sensor in millimetres, pixels
/// counted from the centre of the upper left one, v down.
struct CameraParameters {
  int width = 0, height = 0;                              ///< of the picture, pixels
  double focal = 0;                                       ///< mm
  double kappa1 = 0;                                      ///< 1/mm^2, from distorted to ideal
  double cx = 0, cy = 0;                                  ///< pixel of the optical axis
  double sx = 1;                                          ///< scale of the horizontal scan
  double dpx = 0, dpy = 0;                                ///< mm per pixel
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rx, ry, rz; R = Rz(rz) Ry(ry) Rx(rx)
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m; p_camera = R p_map + translation
  bool carried = false;  ///< a robot carries it: each picture has a pose instead (see Camera::at())
};

/// A camera without distortion whose optical axis meets the middle of its picture, at the map's
/// origin with the camera's own axes (x right, y down, z forward). `width`, `height`, `focal`:
/// pixels.
CameraParameters pinhole(int width, int height, double focal);

/// Where a pixel's ray meets the ground, and how that moves with the pixel.
struct GroundPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m, map frame
  Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();  ///< m per pixel: d(x, y) / d(u, v)
};

/// A point in space that a pixel shows at some depth, and how it moves with them.
struct SpacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, map frame
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  ///< d(x, y, z) / d(u, v, depth)
};

/// Between the map and the picture of a calibrated camera; the ground is z = 0.
class Camera {
 public:
  explicit Camera(const CameraParameters& parameters);

  /// The camera where a pose has it. The axes of the pose are a sensor's (core/frame.h): x along
  /// the optical axis, y to the left of the picture, z to its top.
  Camera at(const Pose& pose) const;

  int width() const { return parameters_.width; }
  int height() const { return parameters_.height; }

  /// The pixel (u, v) of a point of the map; it may lie outside the picture. The point must be in
  /// front of the camera.
  Eigen::Vector2d project(const Eigen::Vector3d& p_map) const;

  /// The ground under a pixel; nothing at and above the horizon. Exact: the model's distortion is
  /// given from picture to ray, so nothing is iterated.
  std::optional<GroundPoint> to_ground(const Eigen::Vector2d& pixel) const;

  /// The same on the plane at height z (m).
  std::optional<GroundPoint> to_plane(const Eigen::Vector2d& pixel, double z) const;

  /// Distance of a point of the map from the camera along its optical axis, m, as depth images
  /// hold it; negative behind the camera.
  double depth(const Eigen::Vector3d& p_map) const;

  /// The point that a pixel shows at a depth (m).
  SpacePoint at_depth(const Eigen::Vector2d& pixel, double depth) const;

  /// The camera whose picture is a part of this one's: pixels count from the part's corner.
  Camera part(int left, int top, int width, int height) const;

 private:
  struct Ray {
    Eigen::Vector3d direction;           ///< camera frame, z = 1
    Eigen::Matrix<double, 3, 2> change;  ///< with the pixel (u, v)
  };
  Ray ray(const Eigen::Vector2d& pixel) const;

  CameraParameters parameters_;
  Eigen::Matrix3d rotation_;  ///< camera (x right, y down, z forward) from map
  Eigen::Vector3d centre_map_;
};

}  // namespace anchord
