// What the daemon receives on LCM beside frames and questions.

#include <utility>

#include "daemon/lcm_front.h"
#include "daemon/verification_routes.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/verification_codec.h"

namespace anchord {

void LcmFront::refuse(const char* channel, const Error& why) {
  ++statistics_.refused_lcm;
  publish_refusal(channel, nullptr, why);
}

void LcmFront::receive_event(std::span<const std::uint8_t> bytes, Journal& journal,
                             Robots& robots) {
  auto message = decode_event(bytes);
  if (!message) return refuse(kEventChannel, message.error());
  Submission submission{{}, kEventChannel, false, {}};
  submission.events = {with_robot(std::move(message->event), robots)};
  submission.bytes = bytes.size();
  if (!journal.submit(std::move(submission)))
    refuse(kEventChannel, {ErrorCode::kUnavailable, "", "too much waits to be applied"});
}

void LcmFront::receive_trigger(std::span<const std::uint8_t> bytes, Verifications& verifications) {
  auto message = decode_trigger(bytes);
  if (!message) return refuse(kTriggerChannel, message.error());
  const auto done = [this](const Result<std::optional<Task>>& task) {
    if (!task) refuse(kTriggerChannel, task.error());
  };
  // Which object is meant may take a while to find out.
  const bool taken = triggers_.post([&verifications, done, asked = std::move(*message)] {
    if (asked.cancel)
      verifications.cancel(asked.task, done);
    else
      verifications.trigger(asked.trigger, done);
  });
  if (!taken) refuse(kTriggerChannel, {ErrorCode::kUnavailable, "", "too many triggers wait"});
}

void LcmFront::receive_result(std::span<const std::uint8_t> bytes, Verifications& verifications) {
  auto result = decode_result(bytes);
  if (!result) return refuse(kResultChannel, result.error());
  const bool taken = triggers_.post([this, &verifications, answer = std::move(*result)] {
    verifications.result(answer, [this](const Result<std::optional<Task>>& task) {
      if (!task) refuse(kResultChannel, task.error());
    });
  });
  if (!taken) refuse(kResultChannel, {ErrorCode::kUnavailable, "", "too many results wait"});
}

void LcmFront::receive_pose(std::span<const std::uint8_t> bytes, Verifications& verifications) {
  const auto pose = decode_pose(bytes);
  if (!pose) return refuse(kPoseChannel, pose.error());
  if (Status taken = verifications.pose(*pose); !taken) refuse(kPoseChannel, taken.error());
}

void LcmFront::publish_task(const Task& task, Utime now) {
  tasks_.post([this, bytes = encode(TaskMessage{now, task})] { send(kTaskChannel, bytes); });
}

}  // namespace anchord
