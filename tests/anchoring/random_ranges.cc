#include "tests/anchoring/random_ranges.h"

#include <variant>

namespace anchord::enumeration {
namespace {

void stand_at(const Eigen::Vector3d& position, Frame& frame) {
  frame.pose.emplace();
  for (int i = 0; i < 3; ++i) frame.pose->position[i] = position[i];
  for (Detection& detection : frame.detections) {
    auto& measured = std::get<CartesianMeasurement>(detection.measurement).position;
    for (std::size_t i = 0; i < measured.size(); ++i) measured[i] -= position[i];
  }
  if (!frame.view) return;
  for (auto& point : frame.view->points)
    for (int i = 0; i < 2; ++i) point[i] -= position[i];
}

}  // namespace

void add_ranges(Scene& scene, Dice& dice) {
  Knowledge& k = scene.knowledge;
  const auto change = [&](Sensor& sensor) {
    for (DetectionProbability& p : sensor.detection_probability)
      if (dice.chance(0.7)) p.per_m = dice.uniform(-0.8, 0.2);
  };
  change(k.default_sensor);
  for (Sensor& sensor : k.sensors) change(sensor);
  for (Frame& frame : scene.frames) {
    if (dice.chance(0.2)) continue;
    Eigen::Vector3d at = k.bounds_min;
    at.head<2>() += k.cell * Eigen::Vector2d(dice.integer(-2, 8), dice.integer(-2, 7));
    at.z() = k.dims == 3 ? dice.pick<double>({-1, 1, 6}) : 0;
    stand_at(at, frame);
  }
}

}  // namespace anchord::enumeration
