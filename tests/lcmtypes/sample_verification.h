#pragma once

#include "core/event.h"
#include "core/verification.h"
#include "lcmtypes/image_codec.h"
#include "lcmtypes/verification_codec.h"
#include "tests/lcmtypes/sample_frames.h"

/// Messages about events and verifications that between them use every field.
namespace anchord::testing {

inline std::vector<RegionOfInterest> two_regions() {
  RegionOfInterest ellipsoid;
  ellipsoid.p = 0.75;
  ellipsoid.center = {1, -2, 0.5};
  ellipsoid.covariance = {0.04, 0, 0, 0, 0.09, 0, 0, 0, 0.01};
  ellipsoid.radius = 2.5;
  RegionOfInterest prism;
  prism.kind = RegionOfInterest::Kind::kPrism;
  prism.p = 0.25;
  prism.polygon = {{0, 0}, {2, 0}, {0, 1.5}};
  prism.z = {0.5, 1.25};
  return {ellipsoid, prism};
}

inline Event full_event() {
  Event event;
  event.kind = Event::Kind::kPlaced;
  event.utime = 1'700'000'000'500'000;
  event.robot = "amigo";
  event.object = "cup-1";
  event.other = "my cup";
  event.place = "kitchen_table";
  event.sensor = "kinect";
  event.position = {1.5, 0.25, 0.75};
  event.covariance = {1e-3, 0, 0, 0, 2e-3, 0, 0, 0, 3e-3};
  event.regions = two_regions();
  event.undone = 12;
  return event;
}

inline TriggerMessage full_trigger() {
  Trigger trigger{"cup-1", "class=cup&color=blue", "grab", "amigo", "kinect", 2.5, true, -7};
  return {1'700'000'000'600'000, false, 0, trigger};
}

inline TriggerMessage cancelling() { return {1'700'000'000'700'000, true, 3, {}}; }

inline TaskMessage full_task() {
  Task task;
  task.id = 3;
  task.state = Task::State::kIssued;
  task.triggered = true;
  task.tags = {-7, 8};
  task.action = "grab";
  task.object = "cup-1";
  task.object_class = "cup";
  task.robot = "amigo";
  task.sensor = "kinect";
  task.wanted_sensor = "any";
  task.created = 1'700'000'001'000'000;
  task.issued = task.created + 1;
  task.ended = task.created + 2;
  task.deadline = task.created + 3;
  task.viewpoint = full_frame().pose;
  task.regions = two_regions();
  task.appearance = full_frame().detections.front().attributes;
  task.extent = {0.09, 0.08, 0.1};
  task.gain_nat = 1.25;
  task.cost = 0.5;
  task.utility = 2.5;
  task.reason = "a planner will grab it";
  return {1'700'000'001'000'004, task};
}

inline VerificationResult full_result() {
  VerificationResult result;
  result.task = 3;
  result.outcome = VerificationResult::Outcome::kFound;
  result.frame = full_frame();
  result.utime = result.frame->utime;
  result.robot = "amigo";
  result.sensor = "kinect";
  return result;
}

inline VerificationResult missing_result() {
  VerificationResult result;
  result.task = 4;
  result.outcome = VerificationResult::Outcome::kMissing;
  result.utime = 1'700'000'002'000'000;
  result.sensor = "kinect";
  return result;
}

inline RobotPose full_pose() { return {1'700'000'000'000'001, "amigo", *full_frame().pose}; }

inline ImageMessage full_image() {
  ImageMessage image;
  image.utime = 1'700'000'000'000'002;
  image.seq = 5;
  image.robot = "amigo";
  image.sensor = "kinect";
  image.pose = full_frame().pose;
  image.width = 3;
  image.height = 2;
  image.format = ImageMessage::Format::kBgr8;
  for (std::uint8_t i = 0; i < 18; ++i) image.data.push_back(i);
  return image;
}

}  // namespace anchord::testing
