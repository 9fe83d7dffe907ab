#include "image_inbox.h"

#include <Eigen/Geometry>
#include <chrono>
#include <cstdlib>

#include "geometry/rotation.h"
#include "image_picture.h"
#include "perception/camera_pose.h"

namespace anchord {

namespace {

bool same(const Pose& a, const Pose& b) {
  const Eigen::Vector3d way =
      Eigen::Vector3d(a.position.data()) - Eigen::Vector3d(b.position.data());
  const Eigen::AngleAxisd turn(rotation_of(a).transpose() * rotation_of(b));
  return way.norm() <= ImageInbox::kSamePlace &&
         std::abs(turn.angle()) <= ImageInbox::kSameDirection;
}

}  // namespace

Status ImageInbox::check_pose_of(const ImageMessage& image) const {
  if (!carried_) {
    if (image.pose) return invalid("pose", "is given, but the camera's file says where it stands");
    return Done{};
  }
  if (!image.pose) return invalid("pose", "is missing: the camera's file does not say where it is");
  return check_camera_pose(*image.pose);
}

bool ImageInbox::together() const {
  if (depth_.empty() || std::llabs(depth_utime_ - color_utime_) > kTogether) return false;
  return !carried_ || same(*color_pose_, *depth_pose_);
}

Status ImageInbox::add(const ImageMessage& image) {
  if (image.robot != robot_ || image.sensor != sensor_) return Done{};
  if (Status good = check_pose_of(image); !good) return good;
  if (image.utime < kEarliestUtime || image.utime > kLatestUtime) {
    return invalid("utime", "is not in the years 2000 to 2100");
  }
  if (image.format == ImageMessage::Format::kDepth16Mm) {
    auto depth = to_depth(image, size_);
    if (!depth) return depth.error();
    const std::lock_guard lock(mutex_);
    depth_ = *depth;
    depth_utime_ = image.utime;
    depth_pose_ = image.pose;
    return Done{};
  }
  auto color = to_picture(image, size_);
  if (!color) return color.error();
  {
    const std::lock_guard lock(mutex_);
    if (image.utime <= color_utime_) return invalid("utime", "is not later than the last one's");
    color_ = *color;
    color_utime_ = image.utime;
    color_pose_ = image.pose;
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
  TimedPicture result{{color_, {}, color_pose_}, color_utime_};
  if (together()) result.picture.depth = depth_;
  return result;
}

}  // namespace anchord
