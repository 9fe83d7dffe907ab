#include "perception/explanation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace anchord {

namespace {

constexpr double kLeastCoverage = 0.02;  ///< below it a pixel is not looked at
constexpr double kRowsLookedAt = 60;     ///< of a person when gains are compared

}  // namespace

Explanation::Explanation(const cv::Mat1f& foreground, const cv::Mat1b& observable,
                         double false_foreground)
    : foreground_(foreground),
      observable_(observable),
      false_foreground_(false_foreground),
      log_background_(foreground.size(), static_cast<float>(std::log1p(-false_foreground))),
      explained_(foreground.size(), static_cast<float>(false_foreground)),
      news_(cv::Mat1f::zeros(foreground.size())) {
  for (std::size_t i = 0; i < kPixels; ++i) {
    const double coverage = (static_cast<double>(i) + 0.5) / kPixels;
    Pixel& pixel = pixels_[i];
    pixel.news = std::log((1 - (1 - coverage) * (1 - false_foreground)) / false_foreground);
    pixel.hole = std::log1p(-coverage);
    pixel.mean = coverage * pixel.news + (1 - coverage) * pixel.hole;
  }
  foreground.copyTo(news_, observable);
  cv::Mat1f holes = cv::Mat1f::zeros(foreground.size());
  cv::subtract(1.0, foreground, holes, observable);
  cv::integral(holes, holes_sum_, CV_64F);
  sum_up();
}

void Explanation::sum_up() { cv::integral(news_, news_sum_, CV_64F); }

double Explanation::sum(const cv::Mat1d& integral, const cv::Rect& r) {
  return integral(r.br().y, r.br().x) - integral(r.y, r.br().x) - integral(r.br().y, r.x) +
         integral(r.y, r.x);
}

void Explanation::add(const Silhouette& person) { change(person, 1); }
void Explanation::remove(const Silhouette& person) { change(person, -1); }

void Explanation::change(const Silhouette& person, double sign) {
  const cv::Rect box = person.box() & cv::Rect(cv::Point(), foreground_.size());
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      const double coverage = person.coverage(x, y);
      if (coverage < kLeastCoverage) continue;
      log_background_(y, x) += static_cast<float>(sign * std::log1p(-coverage));
      const double explained = std::max(1.0 - std::exp(log_background_(y, x)), false_foreground_);
      explained_(y, x) = static_cast<float>(explained);
      if (!observable_(y, x)) continue;
      news_(y, x) =
          foreground_(y, x) * static_cast<float>(std::log(explained) / std::log(false_foreground_));
    }
  }
}

Explanation::Gain Explanation::gain(const Silhouette& person) const {
  const cv::Rect picture(cv::Point(), foreground_.size());
  const cv::Rect box = person.box();
  const int stride = std::max(1, cvRound(person.height_px() / kRowsLookedAt));
  // On a lattice that stays where it is when the person moves, so that gains can be compared.
  const auto first = [&](int start) { return start + (stride - start % stride) % stride; };
  Gain gain;
  for (int y = first(box.y); y < box.br().y; y += stride) {
    for (int x = first(box.x); x < box.br().x; x += stride) {
      const double coverage = person.coverage(x, y);
      if (coverage < kLeastCoverage) continue;
      const Pixel& pixel = pixels_[static_cast<std::size_t>(coverage * (kPixels - 1))];
      gain.full += pixel.mean;
      if (!picture.contains({x, y}) || !observable_(y, x)) continue;
      const double seen = foreground_(y, x);
      gain.won += (1 - seen) * pixel.hole;
      if (seen == 0) continue;
      const double explained = explained_(y, x);
      gain.won += seen * (explained < 1.01 * false_foreground_
                              ? pixel.news
                              : std::log1p(coverage * (1 - explained) / explained));
    }
  }
  return gain;
}

}  // namespace anchord
