#include "bench/building.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace anchord::bench {
namespace {

constexpr double kLength = 6, kWidth = 5, kTop = 2;  // m, of a room about; things stand up to kTop
constexpr double kDetected = 0.9;                    // as the configuration says
constexpr double kRange = 6, kOpening = std::numbers::pi / 2;
constexpr double kPerM2 = 100 / kDetected / (kOpening / 2 * kRange * kRange);
constexpr double kStep = 0.1;       // m
constexpr Utime kPeriod = 200'000;  // us
constexpr double kNoise = 0.02;     // m, standard deviation along each axis
constexpr double kCertain = 0.9;    // of a reported symbol, which is the true one
constexpr double kEye = 1.2;        // m, above the floor
/// Shares of the classes: book, box, chair, cup, folder, plant.
constexpr std::array<double, 6> kShare{0.4, 0.2, 0.03, 0.12, 0.2, 0.05};

SymbolReport report(const std::vector<std::string>& symbols, int symbol) {
  return {{{symbols[symbol], kCertain}}};
}

}  // namespace

Building::Building(int things, const Knowledge& classes, std::uint64_t seed)
    : knowledge_(classes), dice_(seed) {
  const double rooms = things / (kPerM2 * kLength * kWidth);
  columns_ = static_cast<int>(std::ceil(std::sqrt(rooms * kWidth / kLength)));
  rows_ = static_cast<int>(std::ceil(rooms / columns_));
  const double scale = std::sqrt(rooms / this->rooms());
  length_ = scale * kLength;
  width_ = scale * kWidth;
  knowledge_.bounds_max.head<2>() = Eigen::Vector2d(columns_ * length_, rows_ * width_);
  things_.resize(this->rooms());
  for (int i = 0; i < things; ++i) {
    const auto room = static_cast<int>(static_cast<long>(i) * this->rooms() / things);
    Thing thing{};
    thing.position = {(room % columns_ + dice_.uniform(0, 1)) * length_,
                      (room / columns_ + dice_.uniform(0, 1)) * width_, dice_.uniform(0, kTop)};
    double left = dice_.uniform(0, 1);
    while (thing.what + 1 < static_cast<int>(kShare.size()) && left >= kShare[thing.what])
      left -= kShare[thing.what++];
    thing.color = static_cast<int>(dice_.index(knowledge_.attributes[1].symbols.size()));
    things_[room].push_back(thing);
  }
}

Detection Building::detect(const Thing& thing) {
  constexpr double kVariance = kNoise * kNoise;
  CartesianMeasurement measured;
  for (int i = 0; i < 3; ++i) measured.position.push_back(thing.position[i] + dice_.normal(kNoise));
  measured.covariance = {kVariance, 0, 0, 0, kVariance, 0, 0, 0, kVariance};
  Detection detection;
  detection.measurement = measured;
  const auto& attributes = knowledge_.attributes;
  detection.attributes = {{"class", report(attributes[0].symbols, thing.what)},
                          {"color", report(attributes[1].symbols, thing.color)}};
  return detection;
}

Frame Building::inspect(int room) {
  Frame frame;
  frame.utime = now_ += kPeriod;
  frame.sensor = "camera";
  const double x = room % columns_ * length_, y = room / columns_ * width_;
  View view;
  view.type = View::Type::kPolygon;
  view.points = {{x, y}, {x + length_, y}, {x + length_, y + width_}, {x, y + width_}};
  frame.view = view;
  for (const Thing& thing : things_[room]) frame.detections.push_back(detect(thing));
  return frame;
}

/// Lane by lane, there and back, between two rows of rooms; the view stays inside.
Pose Building::pose(int step) const {
  const double length = columns_ * length_, lane = length - kRange;
  const double way = std::fmod(step * kStep, lane * (rows_ - 1));
  const int row = static_cast<int>(way / lane);
  const bool back = row % 2 == 1;
  const double along = way - row * lane;
  Pose pose;
  pose.position = {back ? length - along : along, (row + 1) * width_, kEye};
  if (back) pose.orientation = {0, 0, 0, 1};
  return pose;
}

Frame Building::look(int step) {
  Frame frame;
  frame.utime = now_ += kPeriod;
  frame.sensor = "camera";
  frame.pose = pose(step);
  View view;
  view.type = View::Type::kSector;
  view.range = {0, kRange};
  view.bearing = {-kOpening / 2, kOpening / 2};
  frame.view = view;
  const Eigen::Vector3d eye(frame.pose->position[0], frame.pose->position[1], kEye);
  const double ahead = frame.pose->orientation[0] > 0.5 ? 1 : -1;
  const auto see = [&](const Thing& thing) {
    const Eigen::Vector3d from_eye = thing.position - eye;
    if (from_eye.norm() > kRange || ahead * from_eye.x() < std::abs(from_eye.y())) return;
    Thing seen = thing;
    seen.position = {ahead * from_eye.x(), ahead * from_eye.y(), from_eye.z()};
    frame.detections.push_back(detect(seen));
  };
  for (const auto& room : things_)
    if (!room.empty() && (room[0].position - eye).head<2>().norm() < kRange + length_ + width_)
      for (const Thing& thing : room)
        if (dice_.chance(kDetected)) see(thing);
  // One that is nothing, on average 10^-2 per m^3 as the configuration says, somewhere ahead.
  see({eye + Eigen::Vector3d(ahead * kRange * std::sqrt(dice_.uniform(0, 1)), dice_.uniform(-3, 3),
                             dice_.uniform(-1, 1)),
       0, 0});
  return frame;
}

}  // namespace anchord::bench
