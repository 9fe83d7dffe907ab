#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/frame.h"
#include "perception/silhouette.h"

namespace anchord {

/// A color that has a name: a box in hue, saturation and value (thesis table 2.2: a predicate is
/// grounded in a range of a measured quantity).
struct NamedColor {
  std::string name;
  double hue[2] = {0, 360};  ///< degrees; from the first upwards to the second, through 360
  double saturation[2] = {0, 1};
  double value[2] = {0, 1};

  bool holds(double h, double s, double v) const;
};

/// The named colors of people's clothes.
class ClothesColors {
 public:
  struct Settings {
    std::vector<NamedColor> colors;  ///< of several that hold the first counts
    double doubt = 0.1;              ///< share of every report that is spread over all colors
    double sharpness = 0.1;          ///< exponent of the shares; see report()
    double least_pixels = 30;        ///< of the upper body, for a report at all
  };
  explicit ClothesColors(Settings settings) : settings_(std::move(settings)) {}

  /// Shares of the colors among the foreground pixels of a person's upper body, in the order of
  /// the settings, summing to 1; empty if too few pixels are seen. `frame` is 8-bit BGR; pixels
  /// where `hidden` is not zero belong to someone nearer or to something fixed.
  std::vector<double> shares(const cv::Mat& frame, const cv::Mat1f& foreground,
                             const cv::Mat1b& hidden, const Silhouette& person) const;

  /// What is reported of them: m(s) in proportion to ((1 - doubt) share(s) + doubt / n)^sharpness.
  /// Reports of one person that follow each other repeat nearly the same pixels, while a belief
  /// multiplies them as if each were new: the exponent makes as many reports as come in one
  /// correlation time weigh about as much as one. Colors without pixels are left out of the
  /// report, so that they share evenly what is left.
  SymbolReport report(const std::vector<double>& shares) const;

  const Settings& settings() const { return settings_; }

 private:
  Settings settings_;
};

}  // namespace anchord
