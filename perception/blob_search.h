#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/frame.h"
#include "perception/clothes.h"

namespace anchord {

/// A patch of pixels of one appearance.
struct Blob {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< mean of its pixels
  cv::Rect box;
  double pixels = 0;
  double depth = 0;  ///< median of its pixels, m; 0: unknown
};

/// The names of colors that an object may have: those at least half as probable as the likeliest.
/// Empty if the report is not about symbols or holds none.
std::vector<std::string> likely_colors(const AttributeReport& color);

/// The patches of some named colors in a picture (8-bit BGR). Only pixels where `mask` is not zero
/// are looked at. `gap`: pixels of a patch lie closer together than that; patches of fewer than
/// `least_pixels` are left out. `depth`: of the picture's size in m, or empty.
std::vector<Blob> find_blobs(const cv::Mat& picture, const cv::Mat1b& mask, const cv::Mat1f& depth,
                             const std::vector<NamedColor>& named,
                             const std::vector<std::string>& colors, int gap, int least_pixels);

}  // namespace anchord
