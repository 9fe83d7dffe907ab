#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "perception/camera.h"
#include "perception/clothes.h"
#include "perception/empty_scene.h"
#include "perception/person_search.h"
#include "perception/verifier_settings.h"

namespace anchord {

/// What a camera's file says (see perception/camera_file.h).
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
  EmptyScene::Settings background;
  PersonSearch::Settings search;
  Noise noise_u, noise_v;
  Eigen::Vector2d foot_offset = Eigen::Vector2d::Zero();  ///< to the true foot, in body heights
  Score score;
  ClothesColors::Settings clothes;
  VerifierSettings verification;
};

/// The pixels that nothing fixed hides: 255, and 0 inside the occluders; of the camera's picture,
/// or of the part of it at `where`.
cv::Mat1b observable_pixels(const DetectorSettings& settings);
cv::Mat1b observable_pixels(const DetectorSettings& settings, const cv::Rect& where);

}  // namespace anchord
