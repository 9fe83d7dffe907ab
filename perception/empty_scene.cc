#include "perception/empty_scene.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace anchord {

namespace {

/// Takes the sensor's noise and the codec's edges off before pixels are compared.
cv::Mat3f smoothed(const cv::Mat& frame) {
  cv::Mat blurred;
  // Isolated: a part of a picture is smoothed without what lies around it.
  cv::GaussianBlur(frame, blurred, cv::Size(3, 3), 0, 0, cv::BORDER_DEFAULT | cv::BORDER_ISOLATED);
  cv::Mat3f result;
  blurred.convertTo(result, CV_32F);
  return result;
}

}  // namespace

EmptyScene::EmptyScene(const std::vector<cv::Mat>& frames, const Settings& settings)
    : settings_(settings) {
  CV_Assert(!frames.empty());
  cv::Mat3b median(frames[0].size());
  std::vector<uchar> values(frames.size());
  for (int y = 0; y < median.rows; ++y) {
    for (int x = 0; x < median.cols; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
          values[i] = frames[i].at<cv::Vec3b>(y, x)[channel];
        }
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        median(y, x)[channel] = *middle;
      }
    }
  }
  mean_ = smoothed(median);
}

cv::Mat1f EmptyScene::foreground(const cv::Mat& frame) const {
  return foreground(frame, cv::Rect(cv::Point(), mean_.size()));
}

cv::Mat1f EmptyScene::foreground(const cv::Mat& part, const cv::Rect& where) const {
  CV_Assert(part.size() == where.size());
  const cv::Mat3f now = smoothed(part);
  const cv::Mat3f mean = mean_(where);
  cv::Mat1f result(now.size());
  const auto darkest = static_cast<float>(settings_.darkest);
  const auto brightest = static_cast<float>(settings_.brightest);
  const auto threshold = static_cast<float>(settings_.threshold);
  const auto half_width = static_cast<float>(settings_.width);
  for (int y = 0; y < now.rows; ++y) {
    for (int x = 0; x < now.cols; ++x) {
      const cv::Vec3f& a = now(y, x);
      const cv::Vec3f& b = mean(y, x);
      const float light = std::clamp((a.dot(b) + 1) / (b.dot(b) + 1), darkest, brightest);
      const cv::Vec3f d = a - light * b;
      const float step = (std::sqrt(d.dot(d)) - threshold) / half_width;
      result(y, x) = std::clamp(0.5F + 0.5F * step, 0.0F, 1.0F);
    }
  }
  return result;
}

void EmptyScene::update(const cv::Mat& frame, const cv::Mat1b& occupied) {
  update(frame, cv::Rect(cv::Point(), mean_.size()), occupied);
}

void EmptyScene::update(const cv::Mat& part, const cv::Rect& where, const cv::Mat1b& occupied) {
  cv::Mat3f mean = mean_(where);
  cv::accumulateWeighted(smoothed(part), mean, settings_.rate, occupied == 0);
}

}  // namespace anchord
