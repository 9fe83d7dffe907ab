#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "perception/camera.h"
#include "perception/placement.h"
#include "perception/roi_mask.h"

namespace anchord {

/// What may stand between the camera and an object, in a picture or a part of one.
struct Obstacles {
  cv::Mat1b observable;  ///< zero: something hides what is behind
  cv::Mat1f depth;       ///< m along the optical axis, 0 where unknown; empty: no depth image
};

/// The share of the predicted density from which at least `least_body` of the body would be seen.
/// A pixel hides the body if it lies outside the picture, is not observable, shows something nearer
/// than the body, or its depth is not known.
double visible_share(const Camera& camera, const std::vector<Placement>& places, const Body& body,
                     const Obstacles& obstacles, double least_body);

}  // namespace anchord
