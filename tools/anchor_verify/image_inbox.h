#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "core/time.h"
#include "lcmtypes/image_codec.h"
#include "perception/verifier.h"

namespace anchord {

/// A camera's picture and when it was taken.
struct TimedPicture {
  CameraPicture picture;
  Utime utime = 0;
};

/// The newest picture of one camera that came over LCM. Whoever looks slowly misses pictures; they
/// never pile up. Safe from any thread.
class ImageInbox {
 public:
  /// Color and depth belong together if they were taken within that, microseconds, and, of a
  /// carried camera, its pose is the same within that: m, rad.
  static constexpr Utime kTogether = 50'000;
  static constexpr double kSamePlace = 0.02, kSameDirection = 0.005;

  ImageInbox(std::string robot, std::string sensor, const CameraParameters& camera)
      : robot_(std::move(robot)),
        sensor_(std::move(sensor)),
        size_(camera.width, camera.height),
        carried_(camera.carried) {}

  /// Takes an image; another camera's is nothing. Refuses what cannot be read, a picture older than
  /// the last, one with a pose if the camera's file says where the camera is, and one without or
  /// with one that is none (check_camera_pose()) if it is carried.
  Status add(const ImageMessage& image);

  /// The next picture that nobody had; nothing after `timeout_ms` without one.
  std::optional<TimedPicture> wait(int timeout_ms);

 private:
  /// What pose an image has to have; see add().
  Status check_pose_of(const ImageMessage& image) const;
  /// Whether the depth image belongs to the color image.
  bool together() const;

  std::string robot_, sensor_;
  cv::Size size_;
  bool carried_;
  std::mutex mutex_;
  std::condition_variable came_;
  bool fresh_ = false;
  Utime color_utime_ = 0, depth_utime_ = 0;
  cv::Mat color_;
  cv::Mat1f depth_;
  std::optional<Pose> color_pose_, depth_pose_;
};

}  // namespace anchord
