#pragma once

#include <rapidcheck.h>

#include "core/event.h"
#include "core/verification.h"
#include "lcmtypes/image_codec.h"
#include "lcmtypes/verification_codec.h"
#include "tests/lcmtypes/random_frames.h"

/// Random messages about events and verifications, each as its codec gives it back exactly.
namespace anchord::testing {

inline bool coin() { return *rc::gen::arbitrary<bool>(); }
inline std::int64_t random_integer() { return *rc::gen::arbitrary<std::int64_t>(); }

inline Pose random_pose() { return {random_array<3>(), random_array<4>(), random_array<36>()}; }

inline std::vector<RegionOfInterest> random_regions() {
  std::vector<RegionOfInterest> regions(*rc::gen::inRange<std::size_t>(0, 4));
  for (RegionOfInterest& region : regions) {
    region.p = *numbers();
    if (coin()) {
      region.center = random_array<3>();
      region.covariance = random_array<9>();
      region.radius = *numbers();
    } else {
      region.kind = RegionOfInterest::Kind::kPrism;
      region.polygon.resize(*rc::gen::inRange<std::size_t>(0, 6));
      for (auto& point : region.polygon) point = random_array<2>();
      region.z = random_array<2>();
    }
  }
  return regions;
}

inline Event random_event() {
  Event event;
  event.kind = static_cast<Event::Kind>(*rc::gen::inRange(0, 10));
  event.utime = random_integer();
  for (std::string* text :
       {&event.robot, &event.object, &event.other, &event.place, &event.sensor}) {
    *text = *texts();
  }
  if (coin()) event.position = random_array<3>();
  if (coin()) event.covariance = random_array<9>();
  event.regions = random_regions();
  event.undone = random_integer();
  return event;
}

inline TriggerMessage random_trigger() {
  TriggerMessage message{random_integer(), coin(), 0, {}};
  if (message.cancel) {
    message.task = random_integer();
    return message;
  }
  Trigger& trigger = message.trigger;
  for (std::string* text :
       {&trigger.object, &trigger.description, &trigger.action, &trigger.robot, &trigger.sensor}) {
    *text = *texts();
  }
  trigger.timeout_s = *numbers();
  trigger.alone = coin();
  trigger.tag = random_integer();
  return message;
}

inline Task random_task() {
  Task task;
  task.id = random_integer();
  task.state = static_cast<Task::State>(*rc::gen::inRange(0, 7));
  task.triggered = coin();
  task.tags = *rc::gen::arbitrary<std::vector<std::int64_t>>();
  for (std::string* text : {&task.action, &task.object, &task.object_class, &task.robot,
                            &task.sensor, &task.wanted_sensor, &task.reason}) {
    *text = *texts();
  }
  for (Utime* utime : {&task.created, &task.issued, &task.ended, &task.deadline}) {
    *utime = random_integer();
  }
  if (coin()) task.viewpoint = random_pose();
  task.regions = random_regions();
  task.appearance = random_detection().attributes;
  task.extent = random_array<3>();
  task.gain_nat = *numbers();
  task.cost = *numbers();
  task.utility = *numbers();
  return task;
}

inline VerificationResult random_result() {
  VerificationResult result;
  result.task = random_integer();
  result.outcome = static_cast<VerificationResult::Outcome>(*rc::gen::inRange(0, 3));
  result.utime = random_integer();
  result.robot = *texts();
  result.sensor = *texts();
  if (coin()) result.frame = random_frame();
  return result;
}

inline RobotPose random_robot_pose() { return {random_integer(), *texts(), random_pose()}; }

inline ImageMessage random_image() {
  constexpr std::size_t kPixelBytes[] = {1, 3, 0, 2};  // by format
  ImageMessage image;
  image.utime = random_integer();
  image.seq = random_integer();
  image.robot = *texts();
  image.sensor = *names();
  if (coin()) image.pose = random_pose();
  image.width = *rc::gen::inRange(1, 9);
  image.height = *rc::gen::inRange(1, 9);
  const int format = *rc::gen::inRange(0, 4);
  image.format = static_cast<ImageMessage::Format>(format);
  const bool jpeg = image.format == ImageMessage::Format::kJpeg;
  const std::size_t pixels = static_cast<std::size_t>(image.width * image.height);
  const std::size_t size =
      jpeg ? *rc::gen::inRange<std::size_t>(1, 99) : pixels * kPixelBytes[format];
  image.data =
      *rc::gen::container<std::vector<std::uint8_t>>(size, rc::gen::arbitrary<std::uint8_t>());
  return image;
}

}  // namespace anchord::testing
