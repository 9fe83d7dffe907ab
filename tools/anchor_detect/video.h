#pragma once

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"

namespace anchord {

/// A picture and when it was taken.
struct VideoFrame {
  cv::Mat picture;  ///< 8-bit BGR
  Utime utime = 0;
};

/// A video file, whose frames are stamped by number, or a live camera, stamped by the clock.
class Video {
 public:
  struct Settings {
    std::string input;                 ///< a file, or a camera's number
    cv::Size size;                     ///< that the pictures must have
    std::optional<double> fps;         ///< of a file; default: what the file says
    std::optional<Utime> start_utime;  ///< of a file's first frame; default: when it is opened
  };
  /// Refuses what cannot be opened, and pictures of another size.
  static Result<Video> open(const Settings& settings);

  /// Pictures to learn the background from, evenly over the first seconds. A file starts again at
  /// its first frame afterwards; a live camera cannot, nothing of that time is detected.
  std::vector<cv::Mat> learn(double seconds);

  /// The next picture; nothing at the end.
  std::optional<VideoFrame> next();

  bool live() const { return live_; }

 private:
  cv::VideoCapture capture_;
  std::string input_;
  bool live_ = false;
  double fps_ = 0;
  Utime start_ = 0;
  std::int64_t frames_ = 0;
};

}  // namespace anchord
