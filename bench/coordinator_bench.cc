// Whether the coordinator delays frames: how long a frame takes from its publishing to the world
// after it, without and with a coordinator that is always choosing.

#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "bench/live_daemon.h"
#include "knowledge/configuration.h"

namespace {

using anchord::bench::fail;
using anchord::bench::fixed;
using nlohmann::json;

constexpr int kObjects = 100, kFrames = 1500, kSeenAtOnce = 10;
constexpr double kFramesPerSecond = 100, kSide = 20;
constexpr anchord::Utime kStart = 1'700'000'000'000'000;

/// A hall of 20 x 20 m with things that wander, and a robot with two sensors. Nothing gains enough,
/// so that the coordinator compares everything anew each time it wakes.
anchord::Knowledge knowledge(bool enabled) {
  json scene;
  scene["world"] = {{"dimensions", 2}, {"bounds", {{"min", {0, 0}}, {"max", {kSide, kSide}}}}};
  scene["classes"]["default"] = {
      {"models", {{{"kind", "constant_position"}, {"position_psd", 0.01}}}},
      {"detection_probability", 0.9}};
  for (const auto& [name, range, noise] :
       {std::tuple("near", 2.0, 0.001), std::tuple("far", 6.0, 0.05)})
    scene["sensors"][name] = {
        {"clutter_density", 1e-4},
        {"view", {{"type", "sector"}, {"range", {0.4, range}}, {"bearing", {-1, 1}}}},
        {"noise", {noise, 0, 0, noise}},
        {"verification", {{"dwell", 1}}}};
  scene["maintenance"] = {{"enabled", enabled}, {"threshold", 1e6}, {"planner", "lookahead"}};
  const auto configuration = anchord::parse_configuration(scene.dump());
  if (!configuration.ok()) fail(configuration.mistakes().front().text());
  return configuration.knowledge();
}

/// Frames that see ten of the objects each, in turn.
std::vector<anchord::Frame> frames() {
  std::vector<anchord::Frame> out(kFrames);
  for (int k = 0; k < kFrames; ++k) {
    anchord::Frame& frame = out[static_cast<std::size_t>(k)];
    frame.utime = kStart + static_cast<anchord::Utime>(k * 1e6 / kFramesPerSecond);
    frame.sensor = "far";
    frame.view.emplace().type = anchord::View::Type::kNone;
    for (int i = 0; i < kSeenAtOnce; ++i) {
      const int object = (k * kSeenAtOnce + i) % kObjects;
      const double x = 1 + 2 * (object % 10) + 0.01 * std::sin(k),
                   y = 1 + 2 * (object / 10) + 0.01 * std::cos(k);
      frame.detections.emplace_back().measurement =
          anchord::CartesianMeasurement{{x, y}, {1e-3, 0, 0, 1e-3}};
    }
  }
  return out;
}

void run(bool enabled) {
  anchord::bench::LiveDaemon daemon(knowledge(enabled));
  anchord::bench::LiveRobot robot;
  anchord::RobotPose pose;
  pose.utime = kStart;
  pose.pose.position = {10, 10, 0};
  robot.tell(pose);
  robot.play(frames(), kFramesPerSecond);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the last worlds are on their way
  robot.stop();
  const auto& times = robot.world_latency();
  anchord::bench::print_row({enabled ? "always choosing" : "off", std::to_string(times.count()),
                             fixed(times.median_ms(), 2), fixed(times.p99_ms(), 2),
                             fixed(times.max_ms(), 2)});
}

}  // namespace

int main() {
  spdlog::set_level(spdlog::level::warn);
  std::printf("%d objects, 2 sensors, %g frames a second of %d detections over LCM\n\n", kObjects,
              kFramesPerSecond, kSeenAtOnce);
  anchord::bench::print_head({"coordinator", "frames", "p50 ms", "p99 ms", "max ms"});
  for (const bool enabled : {false, true, false, true}) run(enabled);
  return EXIT_SUCCESS;
}
