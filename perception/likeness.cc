#include "perception/likeness.h"

#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace anchord {

namespace {

// The classifier's window is 64 x 128 with the person 96 tall in the middle.
constexpr double kPersonInWindow = 96;

}  // namespace

Likeness::Likeness() : weights_(cv::HOGDescriptor::getDefaultPeopleDetector()) {}

double Likeness::of(const cv::Mat& frame, const Silhouette& person) const {
  const cv::Size window = descriptor_.winSize;
  const Eigen::Vector2d middle = 0.5 * (person.head + person.foot);
  double best = -std::numeric_limits<double>::infinity();
  for (const double scale : {0.9, 1.0, 1.1}) {
    for (const double shift : {-0.06, 0.0, 0.06}) {
      const double step = scale * person.height_px() / kPersonInWindow;  // pixels per window pixel
      const double left = middle.x() + shift * person.height_px() - 0.5 * window.width * step;
      const double top = middle.y() - 0.5 * window.height * step;
      const cv::Mat1d to_frame = (cv::Mat1d(2, 3) << step, 0, left, 0, step, top);
      cv::Mat crop;
      cv::warpAffine(frame, crop, to_frame, window, cv::WARP_INVERSE_MAP | cv::INTER_LINEAR,
                     cv::BORDER_REPLICATE);
      std::vector<float> features;
      descriptor_.compute(crop, features);
      double margin = weights_.back();
      for (std::size_t i = 0; i < features.size(); ++i) margin += features[i] * weights_[i];
      best = std::max(best, margin);
    }
  }
  return best;
}

}  // namespace anchord
