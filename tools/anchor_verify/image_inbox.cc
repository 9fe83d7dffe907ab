#include "image_inbox.h"

#include <chrono>
#include <cstdlib>

#include "image_picture.h"

namespace anchord {

Status ImageInbox::add(const ImageMessage& image) {
  if (image.robot != robot_ || image.sensor != sensor_) return Done{};
  if (image.pose) return invalid("pose", "is given, but the camera's file says where it stands");
  if (image.utime < kEarliestUtime || image.utime > kLatestUtime) {
    return invalid("utime", "is not in the years 2000 to 2100");
  }
  if (image.format == ImageMessage::Format::kDepth16Mm) {
    auto depth = to_depth(image, size_);
    if (!depth) return depth.error();
    const std::lock_guard lock(mutex_);
    depth_ = *depth;
    depth_utime_ = image.utime;
    return Done{};
  }
  auto color = to_picture(image, size_);
  if (!color) return color.error();
  {
    const std::lock_guard lock(mutex_);
    if (image.utime <= color_utime_) return invalid("utime", "is not later than the last one's");
    color_ = *color;
    color_utime_ = image.utime;
    fresh_ = true;
  }
  came_.notify_one();
  return Done{};
}

std::optional<TimedPicture> ImageInbox::wait(int timeout_ms) {
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, std::chrono::milliseconds(timeout_ms), [&] { return fresh_; });
  if (!fresh_) return std::nullopt;
  fresh_ = false;
  TimedPicture result{{color_, {}}, color_utime_};
  if (!depth_.empty() && std::llabs(depth_utime_ - color_utime_) <= kTogether) {
    result.picture.depth = depth_;
  }
  return result;
}

}  // namespace anchord
