#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "perception/camera.h"

namespace anchord {

/// A standing person in the picture: upright on the ground at `foot`, `height_m` tall.
struct Silhouette {
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();      ///< pixel between the feet
  Eigen::Vector2d head = Eigen::Vector2d::Zero();      ///< pixel of the crown
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< on the ground, m, map frame
  double height_m = 0;

  double height_px() const { return foot.y() - head.y(); }
  /// The rectangle that the body may cover, not clipped to the picture.
  cv::Rect box() const;
  /// The probability that a person's body covers a pixel: 0 outside box().
  double coverage(double u, double v) const;
};

/// The silhouette of a person with the feet at a pixel; nothing where that is not ground.
std::optional<Silhouette> stand(const Camera& camera, const Eigen::Vector2d& foot, double height_m);

}  // namespace anchord
