#include "perception/detector_settings.h"

#include <opencv2/imgproc.hpp>

namespace anchord {

cv::Mat1b observable_pixels(const DetectorSettings& settings) {
  return observable_pixels(settings, cv::Rect(0, 0, settings.camera.width, settings.camera.height));
}

cv::Mat1b observable_pixels(const DetectorSettings& settings, const cv::Rect& where) {
  cv::Mat1b result(where.size(), uchar{255});
  for (const auto& polygon : settings.occluders) {
    std::vector<cv::Point> points;
    for (const auto& point : polygon) points.emplace_back(cvRound(point[0]), cvRound(point[1]));
    cv::fillPoly(result, std::vector<std::vector<cv::Point>>{points}, cv::Scalar(0), cv::LINE_8, 0,
                 -where.tl());
  }
  return result;
}

}  // namespace anchord
