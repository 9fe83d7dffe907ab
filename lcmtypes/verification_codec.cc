#include "lcmtypes/verification_codec.h"

#include <algorithm>
#include <anchord/robot_pose_t.hpp>
#include <anchord/verify_result_t.hpp>
#include <anchord/verify_task_t.hpp>
#include <anchord/verify_trigger_t.hpp>
#include <utility>

#include "lcmtypes/codec.h"
#include "lcmtypes/conversion.h"
#include "lcmtypes/field.h"
#include "lcmtypes/wire_check.h"

namespace anchord {
namespace {

Task from_lcm(const verify_task_t& message) {
  Task task;
  task.id = message.id;
  task.state = static_cast<Task::State>(message.state);
  task.triggered = message.triggered != 0;
  task.tags = message.tags;
  task.action = message.action;
  task.object = message.object;
  task.object_class = message.object_class;
  task.robot = message.robot;
  task.sensor = message.sensor;
  task.wanted_sensor = message.wanted_sensor;
  task.created = message.created;
  task.issued = message.issued;
  task.ended = message.ended;
  task.deadline = message.deadline;
  if (message.has_viewpoint) task.viewpoint = from_lcm(message.viewpoint);
  task.regions = from_lcm(message.regions);
  task.appearance = from_lcm(message.appearance);
  std::ranges::copy(message.extent, task.extent.begin());
  task.gain_nat = message.gain_nat;
  task.cost = message.cost;
  task.utility = message.utility;
  task.reason = message.reason;
  return task;
}

verify_task_t to_lcm(const Task& task) {
  verify_task_t message{};
  message.id = task.id;
  message.state = static_cast<std::int8_t>(task.state);
  message.triggered = task.triggered;
  message.tags = task.tags;
  message.num_tags = static_cast<std::int32_t>(message.tags.size());
  message.action = wire_text(task.action);
  message.object = wire_text(task.object);
  message.object_class = wire_text(task.object_class);
  message.robot = wire_text(task.robot);
  message.sensor = wire_text(task.sensor);
  message.wanted_sensor = wire_text(task.wanted_sensor);
  message.created = task.created;
  message.issued = task.issued;
  message.ended = task.ended;
  message.deadline = task.deadline;
  message.has_viewpoint = task.viewpoint.has_value();
  if (task.viewpoint) message.viewpoint = to_lcm(*task.viewpoint);
  message.regions = to_lcm(task.regions);
  message.num_regions = static_cast<std::int32_t>(message.regions.size());
  message.appearance = to_lcm(task.appearance);
  message.num_appearance = static_cast<std::int32_t>(message.appearance.size());
  std::ranges::copy(task.extent, message.extent);
  message.gain_nat = task.gain_nat;
  message.cost = task.cost;
  message.utility = task.utility;
  message.reason = wire_text(task.reason);
  return message;
}

}  // namespace

Result<TriggerMessage> decode_trigger(std::span<const std::uint8_t> bytes) {
  const auto message = decode_checked<verify_trigger_t>(check_trigger(bytes), bytes);
  if (!message) return message.error();
  if (message->command == verify_trigger_t::CANCEL) {
    return TriggerMessage{message->utime, true, message->task, Trigger{}};
  }
  Trigger trigger;
  trigger.object = message->object;
  trigger.description = message->description;
  trigger.action = message->action;
  trigger.robot = message->robot;
  trigger.sensor = message->sensor;
  trigger.timeout_s = message->timeout_s;
  trigger.alone = message->alone != 0;
  trigger.tag = message->tag;
  return TriggerMessage{message->utime, false, 0, std::move(trigger)};
}

std::vector<std::uint8_t> encode(const TriggerMessage& in) {
  verify_trigger_t message{};
  message.utime = in.utime;
  if (in.cancel) {
    message.command = verify_trigger_t::CANCEL;
    message.task = in.task;
    return encode_message(message);
  }
  message.command = verify_trigger_t::TRIGGER;
  message.object = wire_text(in.trigger.object);
  message.description = wire_text(in.trigger.description);
  message.action = wire_text(in.trigger.action);
  message.robot = wire_text(in.trigger.robot);
  message.sensor = wire_text(in.trigger.sensor);
  message.timeout_s = in.trigger.timeout_s;
  message.alone = in.trigger.alone;
  message.tag = in.trigger.tag;
  return encode_message(message);
}

Result<TaskMessage> decode_task(std::span<const std::uint8_t> bytes) {
  const auto message = decode_checked<verify_task_t>(check_task(bytes), bytes);
  if (!message) return message.error();
  const Field root;
  const Status unique = check_repeats(message->appearance, root.member("appearance"));
  if (!unique) return unique.error();
  return TaskMessage{message->utime, from_lcm(*message)};
}

std::vector<std::uint8_t> encode(const TaskMessage& in) {
  verify_task_t message = to_lcm(in.task);
  message.utime = in.utime;
  return encode_message(message);
}

std::vector<std::uint8_t> canonical_bytes(const Task& task) { return encode_message(to_lcm(task)); }

Result<VerificationResult> decode_result(std::span<const std::uint8_t> bytes) {
  const auto message = decode_checked<verify_result_t>(check_result(bytes), bytes);
  if (!message) return message.error();
  VerificationResult result;
  result.task = message->task;
  result.outcome = static_cast<VerificationResult::Outcome>(message->outcome);
  result.utime = message->utime;
  result.robot = message->robot;
  result.sensor = message->sensor;
  if (!message->has_frame) return result;
  const Field root;
  const Status unique = check_repeats(message->frame, root.member("frame"));
  if (!unique) return unique.error();
  result.frame = from_lcm(message->frame);
  return result;
}

std::vector<std::uint8_t> encode(const VerificationResult& result) {
  verify_result_t message{};
  message.task = result.task;
  message.outcome = static_cast<std::int8_t>(result.outcome);
  message.utime = result.utime;
  message.robot = wire_text(result.robot);
  message.sensor = wire_text(result.sensor);
  message.has_frame = result.frame.has_value();
  if (result.frame) message.frame = to_lcm(*result.frame, 0);
  return encode_message(message);
}

Result<RobotPose> decode_pose(std::span<const std::uint8_t> bytes) {
  const auto message = decode_checked<robot_pose_t>(check_robot_pose(bytes), bytes);
  if (!message) return message.error();
  return RobotPose{message->utime, message->robot, from_lcm(message->pose)};
}

std::vector<std::uint8_t> encode(const RobotPose& pose) {
  robot_pose_t message{};
  message.utime = pose.utime;
  message.robot = wire_text(pose.robot);
  message.pose = to_lcm(pose.pose);
  return encode_message(message);
}

}  // namespace anchord
