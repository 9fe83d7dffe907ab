#include "video.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace anchord {

namespace {

constexpr int kLearnt = 56;  ///< pictures whose median is the background

Utime now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 4 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

Result<Video> Video::open(const Settings& settings) {
  Video video;
  video.input_ = settings.input;
  video.live_ = is_number(settings.input);
  const bool opened = video.live_ ? video.capture_.open(std::stoi(settings.input))
                                  : video.capture_.open(settings.input);
  if (!opened) return invalid(settings.input, "cannot be opened as a video or camera");
  const cv::Size size(static_cast<int>(video.capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
                      static_cast<int>(video.capture_.get(cv::CAP_PROP_FRAME_HEIGHT)));
  if (size != settings.size) {
    return invalid(settings.input, "its pictures are " + std::to_string(size.width) + " x " +
                                       std::to_string(size.height) + ", the camera's file says " +
                                       std::to_string(settings.size.width) + " x " +
                                       std::to_string(settings.size.height));
  }
  video.fps_ = settings.fps.value_or(video.capture_.get(cv::CAP_PROP_FPS));
  if (!(video.fps_ > 0)) {
    if (!video.live_) return invalid(settings.input, "does not say its frame rate; give --fps");
    video.fps_ = 30;
  }
  video.start_ = settings.start_utime.value_or(now());
  return video;
}

std::vector<cv::Mat> Video::learn(double seconds) {
  const int frames = std::max(1, static_cast<int>(seconds * fps_));
  const int stride = (frames + kLearnt - 1) / kLearnt;
  std::vector<cv::Mat> pictures;
  cv::Mat picture;
  for (int i = 0; i < frames && capture_.read(picture); ++i) {
    if (i % stride == 0) pictures.push_back(picture.clone());
  }
  // Opened again, not wound back: seeking is not exact in every container.
  if (!live_) capture_.open(input_);
  return pictures;
}

std::optional<VideoFrame> Video::next() {
  VideoFrame frame;
  if (!capture_.read(frame.picture)) return std::nullopt;
  frame.utime = live_ ? now() : start_ + from_seconds(static_cast<double>(frames_) / fps_);
  ++frames_;
  return frame;
}

}  // namespace anchord
