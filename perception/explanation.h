#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "perception/silhouette.h"

namespace anchord {

/// A picture's foreground and the people who explain it so far. A pixel is foreground with
/// probability 1 - (1 - false_foreground) prod_i (1 - coverage_i); pixels that something fixed
/// hides, or outside the picture, say nothing.
class Explanation {
 public:
  /// `foreground` (probabilities) and `observable` (zero: hidden) are of one size and outlive this.
  Explanation(const cv::Mat1f& foreground, const cv::Mat1b& observable, double false_foreground);

  void add(const Silhouette& person);
  void remove(const Silhouette& person);

  struct Gain {
    double won = 0;   ///< log-likelihood that adding the person wins
    double full = 0;  ///< what one that is wholly seen wins on average
    double share() const { return won / full; }
  };
  /// Of adding one more person.
  Gain gain(const Silhouette& person) const;

  /// Of the pixels in a rectangle inside the picture: those of foreground, each by how little it
  /// is explained (1: not at all), and those of background. As of the last sum_up().
  double news(const cv::Rect& r) const { return sum(news_sum_, r); }
  double holes(const cv::Rect& r) const { return sum(holes_sum_, r); }
  void sum_up();

 private:
  /// What a pixel that a person covers with some probability wins for it.
  struct Pixel {
    double news, hole;  ///< foreground that nobody else explains; background
    double mean;        ///< if the person is there alone
  };
  static constexpr std::size_t kPixels = 256;

  void change(const Silhouette& person, double sign);
  static double sum(const cv::Mat1d& integral, const cv::Rect& r);

  const cv::Mat1f& foreground_;
  const cv::Mat1b& observable_;
  double false_foreground_;
  std::array<Pixel, kPixels> pixels_{};  ///< by coverage, 0 to 1
  cv::Mat1f log_background_;  ///< of the probability that a pixel is background, given the people
  cv::Mat1f explained_;       ///< the probability that it is foreground
  cv::Mat1f news_;
  cv::Mat1d news_sum_, holes_sum_;
};

}  // namespace anchord
