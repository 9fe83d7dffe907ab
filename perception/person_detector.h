#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/frame.h"
#include "perception/background.h"
#include "perception/camera.h"
#include "perception/clothes.h"
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

/// What a camera's file says.
struct DetectorSettings {
  /// Standard deviation of a foot point, in body heights of the picture:
  /// exp(base + covered (1 - alone) + weak max(0, 1 - gain)).
  struct Noise {
    double base = -3, covered = 0, weak = 0;
  };
  /// Log-odds of a person: the sum of weights times what was measured.
  struct Score {
    double bias = 0, gain = 0, filled = 0, observed = 0, alone = 0, likeness = 0;
  };
  std::string sensor = "camera";
  CameraParameters camera;
  std::vector<std::array<double, 2>> view;  ///< pixels: feet that can be seen, a polygon
  std::vector<std::vector<std::array<double, 2>>> occluders;  ///< pixels, polygons
  Background::Settings background;
  PersonSearch::Settings search;
  Noise noise_u, noise_v;
  Eigen::Vector2d foot_offset = Eigen::Vector2d::Zero();  ///< to the true foot, in body heights
  Score score;
  ClothesColors::Settings clothes;
};

/// Detects people in the frames of a fixed, calibrated camera. Deterministic: the same frames in
/// the same order give the same people.
class PersonDetector {
 public:
  /// `background`: frames to learn the empty scene from; see Background.
  PersonDetector(const DetectorSettings& settings, const std::vector<cv::Mat>& background);

  /// `frame`: 8-bit BGR of the camera's size. Takes it up into the background.
  std::vector<DetectedPerson> detect(const cv::Mat& frame);

  /// The ground in view, map frame.
  const View& view() const { return view_; }

  /// People as a frame of detections, in the map frame.
  Frame report(const std::vector<DetectedPerson>& people, Utime utime) const;

 private:
  void place(DetectedPerson& person) const;

  DetectorSettings settings_;
  Camera camera_;
  Background background_;
  cv::Mat1b observable_;
  PersonSearch search_;
  Likeness likeness_;
  ClothesColors clothes_;
  View view_;
};

}  // namespace anchord
