#pragma once

#include <opencv2/core.hpp>

#include "core/result.h"
#include "lcmtypes/image_codec.h"

namespace anchord {

/// A color or gray image as 8-bit BGR. Refuses a size other than `size`, a depth image, and a JPEG
/// that is damaged or of another size than it should be; nothing of it is unpacked before its own
/// header has been held against `size`.
Result<cv::Mat> to_picture(const ImageMessage& image, const cv::Size& size);

/// A depth image in metres, 0 where unknown. Refuses another format or size.
Result<cv::Mat1f> to_depth(const ImageMessage& image, const cv::Size& size);

}  // namespace anchord
