#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace anchord {

/// What the camera sees when nobody is there, and which pixels differ from it. A change of light
/// that leaves a pixel's hue as it was (a shadow, the camera's own exposure) counts for little:
/// the background is scaled by the best factor in an interval before it is compared (after
/// T. Horprasert, D. Harwood, L. Davis, "A statistical approach for real-time robust background
/// subtraction and shadow detection", ICCV 1999 Frame-Rate Workshop).
class EmptyScene {
 public:
  struct Settings {
    double darkest = 0.75;    ///< least factor by which a shadow darkens
    double brightest = 1.15;  ///< largest factor of a change of light
    double threshold = 14;    ///< difference, grey levels, at which a pixel is as likely either
    double width = 5;         ///< of the soft step around it, grey levels
    double rate = 0.01;       ///< share of a new frame in the background
  };

  /// The median of some frames, all 8-bit BGR of one size, at least one. With people who stand
  /// still for less than half of them it is free of people.
  EmptyScene(const std::vector<cv::Mat>& frames, const Settings& settings);
  /// A copy shares nothing.
  EmptyScene(const EmptyScene& other)
      : settings_(other.settings_), mean_(cv::Mat3f(other.mean_.clone())) {}
  EmptyScene(EmptyScene&&) = default;

  /// The probability that each pixel shows something new: 32-bit float in [0, 1].
  cv::Mat1f foreground(const cv::Mat& frame) const;
  /// The same of the part of a frame that lies at `where`; reads no pixel outside it.
  cv::Mat1f foreground(const cv::Mat& part, const cv::Rect& where) const;

  /// Takes up slow changes where `occupied` (8-bit) is zero; people who stand stay people.
  void update(const cv::Mat& frame, const cv::Mat1b& occupied);
  /// The same of the part at `where`; elsewhere the scene stays as it was last seen.
  void update(const cv::Mat& part, const cv::Rect& where, const cv::Mat1b& occupied);

  const cv::Mat3f& picture() const { return mean_; }

 private:
  Settings settings_;
  cv::Mat3f mean_;
};

}  // namespace anchord
