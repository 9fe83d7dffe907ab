#include "image_picture.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace anchord {

namespace {

constexpr int kStart = 0xD8, kFirstFrame = 0xC0, kLastFrame = 0xCF;
constexpr int kHuffman = 0xC4, kReserved = 0xC8, kArithmetic = 0xCC;  ///< that are no frames

/// The size in a JPEG's first frame header (ITU-T T.81, B.2.2).
std::optional<cv::Size> jpeg_size(const std::vector<std::uint8_t>& data) {
  if (data.size() < 2 || data[0] != 0xFF || data[1] != kStart) return std::nullopt;
  std::size_t at = 2;
  while (at + 9 <= data.size() && data[at] == 0xFF) {
    const int marker = data[at + 1];
    const std::size_t length = data[at + 2] * 256U + data[at + 3];
    if (marker >= kFirstFrame && marker <= kLastFrame && marker != kHuffman &&
        marker != kReserved && marker != kArithmetic) {
      return cv::Size(data[at + 7] * 256 + data[at + 8], data[at + 5] * 256 + data[at + 6]);
    }
    if (length < 2) return std::nullopt;
    at += 2 + length;
  }
  return std::nullopt;
}

Result<cv::Mat> from_jpeg(const ImageMessage& image, const cv::Size& size) {
  if (jpeg_size(image.data) != size) return invalid("data", "is no JPEG of the image's size");
  cv::Mat picture;
  try {
    picture = cv::imdecode(image.data, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    picture.release();  // refused like one that cannot be read
  }
  if (picture.size() != size) return invalid("data", "is a damaged JPEG");
  return picture;
}

Status check_size(const ImageMessage& image, const cv::Size& size) {
  if (cv::Size(image.width, image.height) == size) return Done{};
  return invalid("width", "and height are not those of the camera's file");
}

}  // namespace

Result<cv::Mat> to_picture(const ImageMessage& image, const cv::Size& size) {
  if (Status status = check_size(image, size); !status) return status.error();
  if (image.format == ImageMessage::Format::kJpeg) return from_jpeg(image, size);
  if (image.format == ImageMessage::Format::kDepth16Mm) {
    return invalid("format", "is a depth image's");
  }
  const bool gray = image.format == ImageMessage::Format::kGray8;
  const auto bytes = static_cast<std::size_t>(size.area()) * (gray ? 1 : 3);
  if (image.data.size() != bytes) return invalid("data", "is not of the image's size");
  // OpenCV's headers have no view of constant pixels; it is only read and copied.
  const cv::Mat view(size, gray ? CV_8UC1 : CV_8UC3, const_cast<std::uint8_t*>(image.data.data()));
  cv::Mat picture;
  if (gray) {
    cv::cvtColor(view, picture, cv::COLOR_GRAY2BGR);
  } else {
    view.copyTo(picture);
  }
  return picture;
}

Result<cv::Mat1f> to_depth(const ImageMessage& image, const cv::Size& size) {
  if (Status status = check_size(image, size); !status) return status.error();
  const auto pixels = static_cast<std::size_t>(size.area());
  if (image.format != ImageMessage::Format::kDepth16Mm || image.data.size() != 2 * pixels) {
    return invalid("format", "is not a depth image's");
  }
  cv::Mat1f depth(size);
  for (std::size_t i = 0; i < pixels; ++i) {
    const int mm = image.data[2 * i] + 256 * image.data[2 * i + 1];
    depth(static_cast<int>(i) / size.width, static_cast<int>(i) % size.width) =
        static_cast<float>(mm) * 1e-3F;
  }
  return depth;
}

}  // namespace anchord
