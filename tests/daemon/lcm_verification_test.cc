// Triggers, tasks, results, poses and events over LCM, for real: multicast on this machine, ttl 0.

#include <mutex>
#include <nlohmann/json.hpp>
#include <random>

#include "api/lcm_bus.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/verification_codec.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using nlohmann::json;

/// kScene with a camera on the robot that sees 0.4 to 4 m all around, and a coordinator that
/// chooses by itself.
std::string coordinated_scene() {
  json scene = json::parse(kScene);
  scene["classes"]["default"]["models"] =
      json::array({{{"kind", "constant_position"}, {"position_psd", 0.01}}});
  scene["sensors"]["kinect"]["view"] = {
      {"type", "sector"}, {"range", {0.4, 4}}, {"bearing", {-3.14, 3.14}}};
  scene["sensors"]["kinect"]["noise"] = {1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3};
  scene["sensors"]["kinect"]["verification"] = {
      {"mount", {{"position", {0, 0, 1}}, {"orientation", {1, 0, 0, 0}}}}, {"moves_base", true}};
  scene["maintenance"] = {{"enabled", true}, {"threshold", 0.5}};
  return scene.dump();
}

class LcmVerificationTest : public ::testing::Test {
 protected:
  void open(const std::string& scene) {
    std::random_device any;
    const std::string url =
        "udpm://239.255.76.67:" + std::to_string(20'000 + any() % 20'000) + "?ttl=0";
    auto bus = LcmBus::open(url);
    if (!bus)
      GTEST_SKIP() << "\n*** NOT TESTED: verification over real multicast. There is no multicast "
                      "here; `ip route add 224.0.0.0/4 dev lo` would give it. ***";
    bus_ = *std::move(bus);
    ASSERT_TRUE(bus_->subscribe(kTaskChannel,
                                [this](std::span<const std::uint8_t> bytes) {
                                  const auto message = decode_task(bytes);
                                  ASSERT_TRUE(message.ok());
                                  std::lock_guard lock(mutex_);
                                  tasks_.push_back(message->task);
                                })
                    .ok());
    bus_->start();
    DaemonProcess::Options options;
    options.lcm = url;
    options.scene = scene;
    daemon_ = std::make_unique<DaemonProcess>(folder_, options);
    ASSERT_TRUE(daemon_->ready());
    for (int i = 1; i <= 5; ++i)
      ASSERT_EQ(
          ask(daemon_->port(), post("/v1/detections", ::anchord::json(frame_number(i)))).status,
          200);
  }
  void TearDown() override {
    if (bus_) bus_->stop();
  }
  void publish(const char* channel, const std::vector<std::uint8_t>& bytes) {
    ASSERT_TRUE(bus_->publish(channel, bytes).ok());
  }
  void stand_at(double x, double y, Utime utime) {
    RobotPose pose;
    pose.utime = utime;
    pose.pose.position = {x, y, 0};
    publish(kPoseChannel, encode(pose));
  }
  /// The newest record of the task that fits, once there is one.
  Task seen(const std::function<bool(const Task&)>& fits) {
    std::optional<Task> out;
    EXPECT_TRUE(eventually([&] {
      std::lock_guard lock(mutex_);
      for (const Task& task : tasks_)
        if (fits(task)) out = task;
      return out.has_value();
    }));
    return out.value_or(Task{});
  }
  json object(const std::string& id) {
    return json::parse(body(daemon_->port(), "/v1/objects/" + id));
  }

  TestFolder folder_;
  std::unique_ptr<LcmBus> bus_;
  std::unique_ptr<DaemonProcess> daemon_;
  std::mutex mutex_;
  std::vector<Task> tasks_;  // guarded by mutex_
};

TEST_F(LcmVerificationTest, ATriggerIsAnsweredByATaskAndAResultEndsIt) {
  open(kScene);
  if (IsSkipped()) return;
  TriggerMessage trigger;
  trigger.trigger.description = "class=cup";
  trigger.trigger.action = "grab";
  trigger.trigger.tag = 42;
  publish(kTriggerChannel, encode(trigger));
  const Task task = seen([](const Task& t) { return t.state == Task::State::kIssued; });
  EXPECT_EQ(task.object, "cup-1");
  EXPECT_EQ(task.tags, std::vector<std::int64_t>{42});
  VerificationResult result;
  result.task = task.id;
  result.frame = frame_number(6, "verifier");
  result.frame->detections.resize(1);
  result.utime = result.frame->utime;
  publish(kResultChannel, encode(result));
  const Task ended = seen([](const Task& t) { return t.state == Task::State::kFound; });
  EXPECT_EQ(ended.id, task.id);
  EXPECT_EQ(object("cup-1")["last_seen"], frame_number(6).utime);
}

TEST_F(LcmVerificationTest, TheCoordinatorChoosesByItselfOnceItKnowsWhereTheRobotIs) {
  open(coordinated_scene());
  if (IsSkipped()) return;
  EXPECT_EQ(json::parse(body(daemon_->port(), "/v1/verifications"))["verifications"].size(), 0u);
  stand_at(1, 1, frame_number(5).utime);
  const Task task = seen([](const Task& t) { return t.state == Task::State::kIssued; });
  EXPECT_FALSE(task.triggered);
  EXPECT_EQ(task.sensor, "kinect");
  EXPECT_GE(task.gain_nat, 0.5) << "the threshold";
  ASSERT_TRUE(task.viewpoint.has_value());
}

TEST_F(LcmVerificationTest, WhatIsGraspedGoesWithTheRobot) {
  open(kScene);
  if (IsSkipped()) return;
  const Utime now = frame_number(5).utime;
  stand_at(2, 2.5, now);
  Event event;
  event.kind = Event::Kind::kGrasped;
  event.utime = now;
  event.object = "cup-1";
  // The pose must have come before.
  EXPECT_TRUE(eventually([&] {
    event.utime += 1;
    publish(kEventChannel, encode(event, 0));
    return std::abs(object("cup-1")["position"][1].get<double>() - 2.5) < 1e-6;
  }));
  EXPECT_EQ(object("cup-1")["held_by"], "");
  stand_at(7, 6, now + 1'000'000);
  EXPECT_TRUE(eventually(
      [&] { return std::abs(object("cup-1")["position"][0].get<double>() - 7) < 1e-6; }));
  event.kind = Event::Kind::kPlaced;
  publish(kEventChannel, encode(event, 0));
  EXPECT_TRUE(eventually([&] { return !object("cup-1").contains("held_by"); }));
  EXPECT_NEAR(object("cup-1")["position"][1], 6, 1e-6) << "where the robot is";
}

TEST_F(LcmVerificationTest, WhatIsNoMessageIsRefusedAndCounted) {
  open(kScene);
  if (IsSkipped()) return;
  const std::string before = belief(daemon_->port());
  const std::vector<std::uint8_t> junk(64, 0xff);
  for (const char* channel : {kPoseChannel, kEventChannel, kTriggerChannel, kResultChannel})
    publish(channel, junk);
  VerificationResult nothing;
  nothing.task = 77;
  publish(kResultChannel, encode(nothing));
  RobotPose nowhere;
  nowhere.utime = kStart;
  nowhere.pose.position[0] = std::nan("");
  publish(kPoseChannel, encode(nowhere));
  EXPECT_TRUE(eventually([&] { return counter(daemon_->port(), "/lcm/refused") == 6; }));
  EXPECT_EQ(belief(daemon_->port()), before);
}

}  // namespace
}  // namespace anchord
