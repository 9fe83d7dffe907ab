#include "perception/blob_search.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace anchord {

namespace {

constexpr double kLikely = 0.5;  ///< of the likeliest color's probability

/// 255 where a pixel has one of the colors.
cv::Mat1b pixels_of(const cv::Mat& picture, const cv::Mat1b& mask,
                    const std::vector<NamedColor>& named, const std::vector<std::string>& colors) {
  std::vector<bool> wanted;
  for (const NamedColor& color : named) {
    wanted.push_back(std::find(colors.begin(), colors.end(), color.name) != colors.end());
  }
  cv::Mat3f hsv;
  picture.convertTo(hsv, CV_32F, 1.0 / 255);
  cv::cvtColor(hsv, hsv, cv::COLOR_BGR2HSV);
  cv::Mat1b result = cv::Mat1b::zeros(picture.size());
  for (int y = 0; y < hsv.rows; ++y) {
    for (int x = 0; x < hsv.cols; ++x) {
      if (!mask(y, x)) continue;
      const cv::Vec3f& p = hsv(y, x);
      const auto color = std::find_if(named.begin(), named.end(), [&](const NamedColor& each) {
        return each.holds(p[0], p[1], p[2]);
      });
      if (color != named.end() && wanted[static_cast<std::size_t>(color - named.begin())]) {
        result(y, x) = 255;
      }
    }
  }
  return result;
}

double median(std::vector<float>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Blob measured(const cv::Mat1b& pixels, const cv::Mat1i& labels, int label, const cv::Rect& box,
              const cv::Mat1f& depth) {
  Blob blob;
  cv::Point min = box.br(), max = box.tl();
  std::vector<float> depths;
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      if (labels(y, x) != label || !pixels(y, x)) continue;
      blob.middle += Eigen::Vector2d(x, y);
      ++blob.pixels;
      min = {std::min(min.x, x), std::min(min.y, y)};
      max = {std::max(max.x, x), std::max(max.y, y)};
      if (!depth.empty() && depth(y, x) > 0) depths.push_back(depth(y, x));
    }
  }
  if (blob.pixels > 0) {
    blob.middle /= blob.pixels;
    blob.box = cv::Rect(min, max + cv::Point(1, 1));
  }
  blob.depth = median(depths);
  return blob;
}

}  // namespace

std::vector<std::string> likely_colors(const AttributeReport& color) {
  const auto* report = std::get_if<SymbolReport>(&color.value);
  if (!report) return {};
  double most = 0;
  for (const auto& [name, p] : report->probabilities) most = std::max(most, p);
  std::vector<std::string> names;
  for (const auto& [name, p] : report->probabilities) {
    if (p > 0 && p >= kLikely * most) names.push_back(name);
  }
  return names;
}

std::vector<Blob> find_blobs(const cv::Mat& picture, const cv::Mat1b& mask, const cv::Mat1f& depth,
                             const std::vector<NamedColor>& named,
                             const std::vector<std::string>& colors, int gap, int least_pixels) {
  const cv::Mat1b pixels = pixels_of(picture, mask, named, colors);
  cv::Mat1b joined = pixels;
  if (gap > 1) {
    const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, {gap, gap});
    cv::dilate(pixels, joined, kernel, {-1, -1}, 1, cv::BORDER_CONSTANT | cv::BORDER_ISOLATED);
  }
  cv::Mat1i labels, statistics;
  cv::Mat1d middles;
  const int count = cv::connectedComponentsWithStats(joined, labels, statistics, middles, 8);
  std::vector<Blob> blobs;
  for (int label = 1; label < count; ++label) {
    const cv::Rect box(statistics(label, cv::CC_STAT_LEFT), statistics(label, cv::CC_STAT_TOP),
                       statistics(label, cv::CC_STAT_WIDTH), statistics(label, cv::CC_STAT_HEIGHT));
    Blob blob = measured(pixels, labels, label, box, depth);
    if (blob.pixels >= std::max(least_pixels, 1)) blobs.push_back(blob);
  }
  return blobs;
}

}  // namespace anchord
