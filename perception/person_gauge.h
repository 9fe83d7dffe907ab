#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "core/frame.h"
#include "perception/clothes.h"
#include "perception/detector_settings.h"
#include "perception/likeness.h"
#include "perception/person_search.h"

namespace anchord {

/// A detected person. `position` and `covariance` are on the ground, m, map frame.
struct DetectedPerson {
  FoundPerson found;
  double likeness = 0;  ///< see Likeness
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double score = 0;            ///< probability that this is a person, in (0, 1)
  std::vector<double> colors;  ///< shares of the clothes' colors; empty: not seen
};

/// A picture, or a part of one, in which people were found: what they are measured in.
struct PeoplePicture {
  const Camera& camera;         ///< of the part: its pixels are the part's
  const cv::Mat& frame;         ///< 8-bit BGR
  const cv::Mat1f& foreground;  ///< see EmptyScene
  const cv::Mat1b& observable;  ///< zero: something fixed hides people
};

/// Measures people who were found: where they stand and how exactly that is known, what they wear,
/// how probable it is that they are people.
class PersonGauge {
 public:
  explicit PersonGauge(const DetectorSettings& settings);

  /// Of one among all who were found in the picture: those nearer to the camera hide her.
  DetectedPerson measure(const FoundPerson& person, const std::vector<FoundPerson>& people,
                         const PeoplePicture& picture) const;

  /// As it stands in a frame, in the map frame.
  Detection report(const DetectedPerson& person) const;

 private:
  void place(DetectedPerson& person, const Camera& camera) const;

  DetectorSettings settings_;
  Likeness likeness_;
  ClothesColors clothes_;
};

/// Pixels of people who stand nearer to the camera than one does, and what hides people always.
cv::Mat1b hidden_pixels(const FoundPerson& person, const std::vector<FoundPerson>& people,
                        const cv::Mat1b& observable);

/// Numbers are reported no finer than they mean anything, so that the last bits of a machine's
/// mathematics library do not show: positions in steps of 1 / `steps`.
double rounded(double x, double steps);

}  // namespace anchord
