#include "perception/clothes.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace anchord {

namespace {

// The jacket or shirt, without head, hands and what shows beside the body: in heights.
constexpr double kChestTop = 0.20, kChestBottom = 0.48, kChestHalfWidth = 0.11;
constexpr double kLeastShare = 0.02;  ///< less is not worth a name in the report

bool within(double x, const double (&interval)[2]) { return x >= interval[0] && x <= interval[1]; }

}  // namespace

bool NamedColor::holds(double h, double s, double v) const {
  const bool hue_holds = hue[0] <= hue[1] ? within(h, hue) : h >= hue[0] || h <= hue[1];
  return hue_holds && within(s, saturation) && within(v, value);
}

std::vector<double> ClothesColors::shares(const cv::Mat& frame, const cv::Mat1f& foreground,
                                          const cv::Mat1b& hidden, const Silhouette& person) const {
  const cv::Rect box = person.box() & cv::Rect(cv::Point(), frame.size());
  if (box.empty()) return {};
  cv::Mat3f pixels;
  frame(box).convertTo(pixels, CV_32F, 1.0 / 255);
  cv::cvtColor(pixels, pixels, cv::COLOR_BGR2HSV);
  std::vector<double> shares(settings_.colors.size(), 0.0);
  double total = 0;
  for (int y = box.y; y < box.br().y; ++y) {
    const double along = (y - person.head.y()) / person.height_px();
    if (along < kChestTop || along > kChestBottom) continue;
    const double middle = person.head.x() + along * (person.foot.x() - person.head.x());
    for (int x = box.x; x < box.br().x; ++x) {
      if (std::abs(x - middle) > kChestHalfWidth * person.height_px() || hidden(y, x)) continue;
      const double weight = foreground(y, x);
      const cv::Vec3f& hsv = pixels(y - box.y, x - box.x);
      const auto color = std::find_if(
          settings_.colors.begin(), settings_.colors.end(),
          [&](const NamedColor& named) { return named.holds(hsv[0], hsv[1], hsv[2]); });
      if (weight == 0 || color == settings_.colors.end()) continue;
      shares[static_cast<std::size_t>(color - settings_.colors.begin())] += weight;
      total += weight;
    }
  }
  if (total < settings_.least_pixels) return {};
  for (double& share : shares) share /= total;
  return shares;
}

SymbolReport ClothesColors::report(const std::vector<double>& shares) const {
  const double floor = settings_.doubt / static_cast<double>(shares.size());
  const auto weight = [&](double share) {
    return std::pow((1 - settings_.doubt) * share + floor, settings_.sharpness);
  };
  double sum = 0;
  for (const double share : shares) sum += weight(share < kLeastShare ? 0 : share);
  SymbolReport report;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (shares[i] < kLeastShare) continue;
    const double p = std::round(weight(shares[i]) / sum * 1e4) / 1e4;
    report.probabilities.emplace_back(settings_.colors[i].name, p);
  }
  return report;
}

}  // namespace anchord
