#include "bench/hall.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/live_daemon.h"
#include "knowledge/configuration.h"

namespace anchord::bench {
namespace {

constexpr int kSeenAtOnce = 10;
constexpr double kHalf = 10;  // m
constexpr Utime kStart = 1'700'000'000'000'000;

}  // namespace

Knowledge hall(double cell) {
  nlohmann::json scene;
  scene["world"] = {{"dimensions", 2},
                    {"bounds", {{"min", {0, 0}}, {"max", {2 * kHalf, kHalf}}}},
                    {"cell", cell}};
  scene["classes"]["default"] = {
      {"models", {{{"kind", "constant_position"}, {"position_psd", 1e-4}}}},
      {"detection_probability", 0.95}};
  scene["sensors"]["default"] = {{"clutter_density", 1e-4}};
  const auto configuration = parse_configuration(scene.dump());
  if (!configuration.ok()) fail(configuration.mistakes().front().text());
  return configuration.knowledge();
}

std::vector<Frame> hall_frames(int count, double frames_per_second) {
  std::vector<Frame> out;
  for (int k = 0; k < count; ++k) {
    Frame frame;
    frame.utime = kStart + static_cast<Utime>(k * 1e6 / frames_per_second);
    frame.sensor = "camera";
    const double left = k % 2 * kHalf;
    frame.view.emplace().type = View::Type::kPolygon;
    frame.view->points = {{left, 0}, {left + kHalf, 0}, {left + kHalf, kHalf}, {left, kHalf}};
    for (int i = 0; i < kSeenAtOnce; ++i) {
      const double x = left + 1 + 2 * (i % 5) + 0.02 * std::sin(k + i),
                   y = 3 + 4 * (i / 5) + 0.02 * std::cos(k + 2 * i);
      frame.detections.emplace_back().measurement =
          CartesianMeasurement{{x, y}, {1e-3, 0, 0, 1e-3}};
    }
    out.push_back(std::move(frame));
  }
  return out;
}

}  // namespace anchord::bench
