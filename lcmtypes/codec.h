#pragma once

#include <cstdint>
#include <vector>

#include "core/frame.h"

namespace anchord {

/// The frame as an encoded frame_t, as decode_frame() reads it. Canonical: what a view, attribute
/// or measurement does not use is written as zeros, so equal frames give equal bytes, and
/// decode_frame() gives back a frame that encodes to the same bytes; bytes made here are given back
/// exactly. A 2-D position without covariance comes back with z = 0.
///
/// The frame must be one that a decoder could have made: a position has 2 or 3 numbers, no text
/// holds a NUL; else the program aborts. Counts that no decoder makes (a covariance of 7 numbers)
/// are written as they are and refused by decode_frame().
std::vector<std::uint8_t> encode(const Frame& frame, std::int64_t seq);

/// What the frame log stores, and what two frames are compared by: encode() without a number.
std::vector<std::uint8_t> canonical_bytes(const Frame& frame);

/// Any message that lcm-gen made a class for, encoded. Its counts must be right and its texts free
/// of NUL, as lcm-gen's classes demand.
template <typename Message>
std::vector<std::uint8_t> encode_message(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace anchord
