#include "experiments/anchoring/camera.h"

#include <cmath>

namespace anchord::experiment {
namespace {

constexpr Utime kStart = 1'700'000'000'000'000;   // any time that a frame may carry
constexpr double kVariance = 0.0008;              // m^2 per axis, thesis section 2.6.1
constexpr double kHeight = 0.87;                  // m, of its example's position
constexpr double kLowest = 0.7, kHighest = 1.15;  // m, of what may be seen on the table

}  // namespace

Frame Camera::frame(double time, const std::optional<Rectangle>& seen) const {
  Frame frame;
  frame.utime = kStart + from_seconds(time);
  frame.sensor = name_;
  View& view = frame.view.emplace();
  if (!seen) return frame;
  view.type = View::Type::kPolygon;
  view.points = {{seen->low.x(), seen->low.y()},
                 {seen->high.x(), seen->low.y()},
                 {seen->high.x(), seen->high.y()},
                 {seen->low.x(), seen->high.y()}};
  return frame;
}

Detection Camera::measured(const Eigen::Vector2d& position) {
  const double s = std::sqrt(kVariance), v = kVariance;
  const double x = position.x() + s * dice_.normal(), y = position.y() + s * dice_.normal();
  Detection detection;
  detection.measurement =
      CartesianMeasurement{{x, y, kHeight + s * dice_.normal()}, {v, 0, 0, 0, v, 0, 0, 0, v}};
  return detection;
}

std::optional<Detection> Camera::look(const Eigen::Vector2d& position) {
  if (!dice_.happens(detection_probability_)) return std::nullopt;
  return measured(position);
}

std::vector<Detection> Camera::false_positives(const Rectangle& seen) {
  std::vector<Detection> all;
  // Poisson: how many uniform numbers have a product above exp(-mean) (Knuth 1969).
  for (double product = dice_.uniform(); product > std::exp(-false_positives_);
       product *= dice_.uniform()) {
    const Eigen::Vector2d position = table().draw(dice_);
    if (!seen.contains(position)) continue;
    std::get<CartesianMeasurement>(all.emplace_back(measured(position)).measurement).position[2] =
        dice_.uniform(kLowest, kHighest);
  }
  return all;
}

AttributeReport label(const std::string& attribute, const std::string& right,
                      const std::vector<std::string>& others, double probability, Dice& dice) {
  if (dice.happens(probability)) return {attribute, SymbolReport{{{right, probability}}}};
  const auto other = static_cast<std::size_t>(dice.uniform(0, static_cast<double>(others.size())));
  return {attribute, SymbolReport{{{others[other], probability}}}};
}

}  // namespace anchord::experiment
