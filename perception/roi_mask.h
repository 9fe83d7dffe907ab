#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "core/event.h"
#include "perception/camera.h"

namespace anchord {

/// The upright cylinder about an object's position that holds its body, whichever way it is
/// turned; metres.
struct Body {
  double radius = 0;
  double below = 0, above = 0;  ///< of the position
  double height() const { return below + above; }
};

/// Of an object of a class' extent (length, width, height). In a 2-D world the position is the
/// point on the ground that the object stands on, in a 3-D world the middle of the object.
Body body_of(const std::array<double, 3>& extent, int dims);

/// The pixels that an object may cover when its position lies in a region of interest.
struct RoiMask {
  cv::Rect box;    ///< in the picture; empty: the region cannot be seen
  cv::Mat1b mask;  ///< of the box's size: 255 where a body in the region may be
};

/// Projects regions into the picture: every pixel that a body in one of them may cover is in the
/// mask, and few others (each region's share of it is convex). Where a region reaches behind the
/// camera that is the whole picture; one that lies behind it has no pixels.
RoiMask roi_mask(const Camera& camera, const std::vector<RegionOfInterest>& regions,
                 const Body& body, int dims);

/// The pixels that a body covers at a position, as a rectangle, not clipped to the picture; empty
/// where that reaches behind the camera.
cv::Rect body_box(const Camera& camera, const Eigen::Vector3d& position, const Body& body);

}  // namespace anchord
