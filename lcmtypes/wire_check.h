#pragma once

#include <cstdint>
#include <span>

#include "core/result.h"

namespace anchord {

/// Whether the code that lcm-gen 1.3.1 generates can safely decode these bytes. That code trusts
/// what it reads: a negative count throws, a large one allocates gigabytes or reads past the end,
/// a string of length 0 is taken for one of length -1. So every count is held against the bytes
/// that are left first. Checked besides: the fingerprint, limits (lcmtypes/names.h), text, booleans
/// and enumerators, counts that fit together, and that nothing follows the message. Numbers are
/// not looked at. An error names the field, for example `detections[3].num_covariance`.
Status check_frame(std::span<const std::uint8_t> bytes);
Status check_query(std::span<const std::uint8_t> bytes);
Status check_event(std::span<const std::uint8_t> bytes);
Status check_trigger(std::span<const std::uint8_t> bytes);
Status check_task(std::span<const std::uint8_t> bytes);
Status check_result(std::span<const std::uint8_t> bytes);
Status check_robot_pose(std::span<const std::uint8_t> bytes);
Status check_image(std::span<const std::uint8_t> bytes);

}  // namespace anchord
