#pragma once

#include <anchord/attribute_t.hpp>
#include <anchord/frame_t.hpp>
#include <anchord/pose_t.hpp>
#include <anchord/region_t.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/event.h"
#include "core/frame.h"
#include "core/result.h"
#include "lcmtypes/field.h"

namespace anchord {

/// Between the classes of lcm-gen and the values of core/, for messages whose bytes have passed
/// their check, and values that a decoder could have made.

Pose from_lcm(const pose_t& message);
pose_t to_lcm(const Pose& pose);

AttributeReport from_lcm(const attribute_t& message);
attribute_t to_lcm(const AttributeReport& report);
std::vector<AttributeReport> from_lcm(const std::vector<attribute_t>& messages);
std::vector<attribute_t> to_lcm(const std::vector<AttributeReport>& reports);

std::vector<RegionOfInterest> from_lcm(const std::vector<region_t>& messages);
std::vector<region_t> to_lcm(const std::vector<RegionOfInterest>& regions);

Frame from_lcm(const frame_t& message);
frame_t to_lcm(const Frame& frame, std::int64_t seq);

/// Refuses an attribute, or a symbol of one, that is there twice.
Status check_repeats(const std::vector<attribute_t>& attributes, const Field& list);
Status check_repeats(const frame_t& frame, const Field& field);

/// `value`, which must not hold a NUL: else aborts.
std::string wire_text(const std::string& value);

/// lcm-gen's decoding of bytes that have been `checked`. An error if they were refused, or if
/// lcm-gen disagrees with the check about their size.
template <typename Message>
Result<Message> decode_checked(const Status& checked, std::span<const std::uint8_t> bytes) {
  if (!checked) return checked.error();
  Message message;
  const int size = static_cast<int>(bytes.size());  // at most kMaxImageMessageBytes
  if (message.decode(bytes.data(), 0, size) == size) return message;
  return invalid("", "the message does not decode to its own size");
}

}  // namespace anchord
