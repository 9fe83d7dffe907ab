#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/result.h"
#include "core/time.h"

namespace anchord {

/// A camera's image as it comes over LCM.
struct ImageMessage {
  enum class Format {
    kGray8 = 0,     ///< a byte for each pixel
    kBgr8 = 1,      ///< three: blue, green, red
    kJpeg = 2,      ///< a JPEG file
    kDepth16Mm = 3  ///< two, little-endian: distance along the optical axis, mm; 0: unknown
  };
  Utime utime = 0;
  std::int64_t seq =
      0;              ///< counts up by 1 for each image of its publisher, from 1; 0: not numbered
  std::string robot;  ///< whose camera it is; empty for the only one
  std::string sensor;
  std::optional<Pose> pose;   ///< of the camera, map frame; x forward, y left, z up
  int width = 0, height = 0;  ///< pixels
  Format format = Format::kGray8;
  std::vector<std::uint8_t> data;  ///< rows from the top, nothing between them; kJpeg: the file
  bool operator==(const ImageMessage&) const = default;
};

/// The image in an encoded image_t. The bytes are untrusted: see check_image() for what is refused;
/// `data` that is not of the size that width, height and format say is too. A JPEG is not looked
/// into: it may be damaged, or larger than it says.
Result<ImageMessage> decode_image(std::span<const std::uint8_t> bytes);

/// The image as an encoded image_t. Canonical, and with the same demands as a frame's encoding
/// (lcmtypes/codec.h).
std::vector<std::uint8_t> encode(const ImageMessage& image);

}  // namespace anchord
