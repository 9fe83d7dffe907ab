#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "plaza.h"
#include "sightings.h"

namespace anchord {

inline constexpr std::array<double, 3> kBall{0.6, 0.6, 0.6};

/// A depth camera 1.2 m above the ground that looks along x, as a Kinect would: 640 x 480, focal
/// length 525 pixels.
inline DetectorSettings kinect() {
  DetectorSettings settings = plaza_settings();
  settings.occluders.clear();
  CameraParameters& c = settings.camera;
  c = pinhole(640, 480, 525);
  // Camera axes: x to the right (-y), y down (-z), z forward (x).
  c.rotation = {M_PI / 2, -M_PI / 2, 0};
  Eigen::Matrix3d r;
  r << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  c.translation = -r * Eigen::Vector3d(0, 0, 1.2);
  return settings;
}

/// A ball in the picture of a camera: its silhouette by the rays that meet it; and in a depth
/// image.
inline void draw_ball(const Camera& camera, const Eigen::Vector3d& middle, double radius,
                      const cv::Scalar& color, cv::Mat& frame, cv::Mat1f* depth = nullptr) {
  const Eigen::Vector3d eye = camera.at_depth({0, 0}, 0).position;
  for (int y = 0; y < frame.rows; ++y) {
    for (int x = 0; x < frame.cols; ++x) {
      const Eigen::Vector3d ray = camera.at_depth(Eigen::Vector2d(x, y), 1).position - eye;
      const Eigen::Vector3d d = ray.normalized();
      const double along = d.dot(middle - eye);
      const double off2 = (middle - eye).squaredNorm() - along * along;
      if (off2 > radius * radius) continue;
      for (int i = 0; i < 3; ++i) {
        frame.at<cv::Vec3b>(y, x)[i] = static_cast<uchar>(color[i]);
      }
      if (!depth) continue;
      const double distance = along - std::sqrt(radius * radius - off2);
      (*depth)(y, x) = static_cast<float>(distance / ray.norm());
    }
  }
}

inline Task ball_task(const Eigen::Vector3d& center, double deviation,
                      const std::string& color = "red") {
  Task task;
  task.object = "ball-1";
  task.object_class = "ball";
  task.extent = kBall;
  task.appearance = {{"color", SymbolReport{{{color, 0.9}}}}};
  task.regions = {ellipsoid(center, deviation, 2.8)};
  return task;
}

/// Sensor noise, and a ball whose size differs from its class' as the settings say.
struct Draws {
  std::mt19937_64 random{1};
  double normal() { return std::normal_distribution<double>()(random); }
  double radius(const VerifierSettings& settings) {
    return kBall[2] / 2 * (1 + settings.size_deviation * std::clamp(normal(), -2.5, 2.5));
  }
  void add_noise(cv::Mat& frame) {
    cv::Mat noise(frame.size(), CV_16SC3);
    cv::RNG rng(random());
    rng.fill(noise, cv::RNG::NORMAL, 0, 8);
    cv::Mat wide;
    frame.convertTo(wide, CV_16S);
    wide += noise;
    wide.convertTo(frame, CV_8U);
  }
};

/// Mean NEES of `found` draws lies below the 99.9 % point of its law if the covariance is honest.
/// It may be smaller than the mean of that law: edges in shadow and bodies that are no balls are
/// allowed for, which these pictures do not have; but standard deviations three times too large are
/// not honest either.
inline void expect_consistent(double sum, int found, int dims) {
  const double mean = sum / found;
  EXPECT_LT(mean, dims + 3.1 * std::sqrt(2.0 * dims / found));
  EXPECT_GT(mean, dims / 9.0);
}

}  // namespace anchord
