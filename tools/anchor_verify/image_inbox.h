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
  /// Color and depth belong together if they were taken within that.
  static constexpr Utime kTogether = 50'000;

  ImageInbox(std::string robot, std::string sensor, cv::Size size)
      : robot_(std::move(robot)), sensor_(std::move(sensor)), size_(size) {}

  /// Takes an image; another camera's is nothing. Refuses what cannot be read, a picture older than
  /// the last, and one with a pose: the camera's file says where the camera is.
  Status add(const ImageMessage& image);

  /// The next picture that nobody had; nothing after `timeout_ms` without one.
  std::optional<TimedPicture> wait(int timeout_ms);

 private:
  std::string robot_, sensor_;
  cv::Size size_;
  std::mutex mutex_;
  std::condition_variable came_;
  bool fresh_ = false;
  Utime color_utime_ = 0, depth_utime_ = 0;
  cv::Mat color_;
  cv::Mat1f depth_;
};

}  // namespace anchord
