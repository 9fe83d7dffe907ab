#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "core/time.h"
#include "core/verification.h"

namespace anchord {

/// The messages between planners, the coordinator and verification modules. The bytes that the
/// decoders take are untrusted: see check_trigger() and its like for what is refused. Texts,
/// counts, flags and enumerators are sound in what they give; whether a message has what it needs
/// (a found result its frame), and what the numbers mean, is checked where they are used. What
/// the message's own flags leave unused is not looked at and has its default.
///
/// The encodings are canonical and demand the same as that of a frame (lcmtypes/codec.h).

/// A trigger as it came over LCM, or the wish to cancel a task.
struct TriggerMessage {
  Utime utime = 0;  ///< when it was sent
  bool cancel = false;
  std::int64_t task = 0;  ///< id of the task to cancel; 0 in a trigger
  Trigger trigger;        ///< the default if `cancel`
  bool operator==(const TriggerMessage&) const = default;
};

/// A task as it is told over LCM.
struct TaskMessage {
  Utime utime = 0;  ///< when it was published
  Task task;
  bool operator==(const TaskMessage&) const = default;
};

Result<TriggerMessage> decode_trigger(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> encode(const TriggerMessage& message);

/// Refused besides: an attribute of the appearance, or a symbol of one, that is there twice.
Result<TaskMessage> decode_task(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> encode(const TaskMessage& message);

/// What a store of tasks keeps: the encoding of the task without a time of publication.
std::vector<std::uint8_t> canonical_bytes(const Task& task);

/// Refused besides: a frame with repeats, as decode_frame() refuses it.
Result<VerificationResult> decode_result(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> encode(const VerificationResult& result);

Result<RobotPose> decode_pose(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> encode(const RobotPose& pose);

}  // namespace anchord
