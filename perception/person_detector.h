#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/frame.h"
#include "perception/camera.h"
#include "perception/detector_settings.h"
#include "perception/empty_scene.h"
#include "perception/person_gauge.h"
#include "perception/person_search.h"

namespace anchord {

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
  DetectorSettings settings_;
  Camera camera_;
  EmptyScene scene_;
  cv::Mat1b observable_;
  PersonSearch search_;
  PersonGauge gauge_;
  View view_;
};

}  // namespace anchord
