#include "bench/crowd.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "knowledge/configuration.h"

namespace anchord::bench {

double Dice::uniform(double low, double high) {
  return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

double Dice::normal(double deviation) {
  // Box and Muller 1958; one of the pair is enough.
  const double radius = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
  return deviation * radius * std::cos(2 * std::numbers::pi * uniform(0, 1));
}

std::size_t Dice::index(std::size_t count) {
  const auto i = static_cast<std::size_t>(uniform(0, static_cast<double>(count)));
  return i < count ? i : count - 1;
}

namespace {

constexpr Utime kStart = 1'700'000'000'000'000;

struct Walker {
  Eigen::Vector2d position, velocity;

  /// One step of white acceleration, exactly: the noise of position and velocity has the
  /// covariance psd [[dt^3/3, dt^2/2], [dt^2/2, dt]] (Bar-Shalom, Li, Kirubarajan 2001, 6.2.2).
  void step(double psd, double dt, Dice& dice) {
    for (int axis = 0; axis < 2; ++axis) {
      const double push = dice.normal(std::sqrt(psd * dt));
      position[axis] +=
          velocity[axis] * dt + push * dt / 2 + dice.normal(std::sqrt(psd * dt * dt * dt / 12));
      velocity[axis] += push;
    }
  }
};

Detection detection_at(double x, double y, double noise_deviation) {
  const double variance = noise_deviation * noise_deviation;
  Detection detection;
  detection.measurement = CartesianMeasurement{{x, y}, {variance, 0, 0, variance}};
  return detection;
}

Frame observe(const std::vector<Walker>& walkers, const CrowdParameters& p, Dice& dice) {
  Frame frame;
  frame.sensor = "camera";
  frame.view.emplace().type = View::Type::kWorld;
  auto& seen = frame.detections;
  for (const Walker& walker : walkers) {
    if (!dice.chance(p.detection_probability)) continue;
    const double x = walker.position.x() + dice.normal(p.noise_deviation);
    const double y = walker.position.y() + dice.normal(p.noise_deviation);
    seen.push_back(detection_at(x, y, p.noise_deviation));
  }
  const double x = dice.uniform(0, p.side_m), y = dice.uniform(0, p.side_m);
  seen.push_back(detection_at(x, y, p.noise_deviation));
  for (std::size_t i = seen.size() - 1; i > 0; --i) std::swap(seen[i], seen[dice.index(i + 1)]);
  return frame;
}

}  // namespace

Crowd simulate(const CrowdParameters& p, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Walker> walkers(p.objects);
  for (Walker& walker : walkers)
    for (int axis = 0; axis < 2; ++axis) {
      walker.position[axis] = dice.uniform(0, p.side_m);
      walker.velocity[axis] = dice.normal(p.speed_deviation);
    }
  Crowd crowd;
  for (int k = 0; k < p.frames(); ++k) {
    if (k > 0)
      for (Walker& walker : walkers) walker.step(p.acceleration_psd, 1 / p.rate_hz, dice);
    crowd.frames.push_back(observe(walkers, p, dice));
    crowd.frames.back().utime = kStart + from_seconds(k / p.rate_hz);
    auto& truth = crowd.truth.emplace_back();
    for (const Walker& walker : walkers) truth.push_back(walker.position);
  }
  return crowd;
}

std::string crowd_configuration(const CrowdParameters& p) {
  char text[1024];
  std::snprintf(text, sizeof text, R"({
    "world": {"dimensions": 2, "bounds": {"min": [%g, %g], "max": [%g, %g]}},
    "classes": {"default": {
      "models": [{"kind": "constant_velocity", "acceleration_psd": %.17g,
                  "initial_velocity_variance": %.17g}],
      "detection_probability": %.17g, "arrival_rate": 1e-5, "departure_rate": 1e-3,
      "undetected_intensity": 0.05}},
    "sensors": {"default": {"clutter_density": %.17g}}})",
                -p.side_m, -p.side_m, 2 * p.side_m, 2 * p.side_m, p.acceleration_psd,
                p.speed_deviation * p.speed_deviation, p.detection_probability,
                1 / (p.side_m * p.side_m));
  return text;
}

Knowledge crowd_knowledge(const CrowdParameters& p) {
  const auto configuration = parse_configuration(crowd_configuration(p));
  if (configuration.ok()) return configuration.knowledge();
  for (const auto& mistake : configuration.mistakes())
    std::fprintf(stderr, "crowd: %s\n", mistake.text().c_str());
  std::abort();
}

}  // namespace anchord::bench
