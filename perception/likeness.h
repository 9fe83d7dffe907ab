#pragma once

#include <opencv2/core.hpp>
#include <opencv2/objdetect.hpp>
#include <vector>

#include "perception/silhouette.h"

namespace anchord {

/// How much a part of the picture looks like a walking or standing person: the margin of OpenCV's
/// built-in linear classifier over histograms of oriented gradients (N. Dalal, B. Triggs,
/// "Histograms of oriented gradients for human detection", CVPR 2005). It tells people from cars;
/// over the whole picture it would be slow and miss people, on found silhouettes it is cheap.
class Likeness {
 public:
  Likeness();

  /// The largest margin over small shifts and scales about the silhouette; positive: a person.
  double of(const cv::Mat& frame, const Silhouette& person) const;

 private:
  cv::HOGDescriptor descriptor_;
  std::vector<float> weights_;
};

}  // namespace anchord
