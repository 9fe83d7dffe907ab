#include "experiments/soak/watching.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/region.h"

namespace anchord::experiment {
namespace {

constexpr std::array<std::array<double, 2>, 11> kRound{{{6, 4.55},
                                                        {2.5, 4.5},
                                                        {1.9, 1.5},
                                                        {7.7, 4.5},
                                                        {7.2, 2},
                                                        {10, 2.8},
                                                        {8.4, 4.6},
                                                        {9, 7},
                                                        {5.7, 6.5},
                                                        {3.4, 6.2},
                                                        {3.4, 4.6}}};
constexpr double kQuarter = 2;       // s that it looks into each direction
constexpr double kHeld = 0.4;        // of a thing's detection probability while it is carried
constexpr double kPoseSigma = 0.01;  // m, of where the robot believes that it is
constexpr double kTwice = 0.02;      // of what is detected is reported twice
constexpr double kColorRight = 0.85;

bool is_robot(const Sensor& sensor) { return sensor.verification.has_value(); }

}  // namespace

Watch::Watch(const Knowledge& knowledge, const Site& site, std::uint64_t seed)
    : knowledge_(knowledge), site_(site), dice_(seed), robot_({kRound[0][0], kRound[0][1]}) {}

void Watch::step(double dt) {
  if (!robot_.arrived()) {
    robot_.drive(site_.settings.speed * dt);
    if (robot_.arrived()) quarters_ = 4, dwell_ = kQuarter;
    return;
  }
  if ((dwell_ -= dt) > 0) return;
  BasePose end = robot_.base();
  if (--quarters_ > 0) {
    end.yaw += std::numbers::pi / 2;
    robot_.set_out({{end.position}, 0}, end);
    robot_.drive(0);
    dwell_ = kQuarter;
    return;
  }
  const auto& next = kRound[++stop_ % kRound.size()];
  end.position = {next[0], next[1]};
  robot_.set_out(site_.ways.way(site_.ways.start(robot_.base().position), end.position), end);
}

Frame Watch::robot_camera(const Home& home, Utime utime) {
  const Eye& eye = site_.eyes[0];
  const Sensor& sensor = knowledge_.sensors[static_cast<std::size_t>(eye.sensor)];
  const BasePose base = robot_.base();
  Frame frame;
  frame.utime = utime;
  frame.sensor = sensor.name;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(base.yaw).toRotationMatrix();
  const Eigen::Matrix3d map_from_sensor = turn * eye.rotation;
  const Eigen::Vector3d at = site_.stance(eye, base).sensor;
  const Eigen::Quaterniond q(map_from_sensor);
  Pose& pose = frame.pose.emplace();
  pose.position = {at.x() + kPoseSigma * dice_.normal(), at.y() + kPoseSigma * dice_.normal(),
                   at.z()};
  pose.orientation = {q.w(), q.x(), q.y(), q.z()};
  pose.covariance[0] = pose.covariance[7] = kPoseSigma * kPoseSigma;
  look(sensor, home, at, map_from_sensor, frame);
  return frame;
}

Frame Watch::hall_camera(const Home& home, Utime utime) {
  Frame frame;
  frame.utime = utime;
  frame.sensor = "hall_camera";
  look(knowledge_.sensor(frame.sensor), home, {0, 0, 0}, Eigen::Matrix3d::Identity(), frame);
  return frame;
}

std::vector<Watch::Seen> Watch::visible(const Home& home) {
  std::vector<Seen> seen;
  for (const HomeThing& thing : home.things())
    if (thing.here())
      seen.push_back(
          {thing.object_class, thing.color, thing.position, thing.carrier < 0 ? 1 : kHeld});
  for (const Dweller& dweller : home.dwellers())
    if (dweller.here)
      seen.push_back({dweller.object_class,
                      dweller.color,
                      {dweller.position.x(), dweller.position.y(), dweller.height},
                      1});
  return seen;
}

bool Watch::sees(const Sensor& sensor, const Eigen::Vector3d& point_map) const {
  if (is_robot(sensor)) return site_.sees(site_.eyes[0], robot_.base(), point_map);
  Region area;
  for (const auto& [x, y] : sensor.view->points) area.polygon.emplace_back(x, y);
  return area.contains(point_map, 3);
}

void Watch::look(const Sensor& sensor, const Home& home, const Eigen::Vector3d& eye_map,
                 const Eigen::Matrix3d& map_from_sensor, Frame& frame) {
  for (const Seen& thing : visible(home)) {
    if (!sees(sensor, thing.position)) continue;
    const Eigen::Vector3d away = map_from_sensor.transpose() * (thing.position - eye_map);
    const double p =
        sensor.detection_probability[static_cast<std::size_t>(thing.object_class)].at(away.norm());
    if (!dice_.happens(thing.share * p)) continue;
    for (int times = is_robot(sensor) && dice_.happens(kTwice) ? 2 : 1; times > 0; --times) {
      Eigen::Vector3d measured = away;
      for (int i = 0; i < 3; ++i)
        measured[i] += std::sqrt(sensor.noise[static_cast<std::size_t>(4 * i)]) * dice_.normal();
      report(sensor, thing.object_class, thing.color, true, measured, frame);
    }
  }
  clutter(sensor, eye_map, map_from_sensor, frame);
}

/// Poisson, of the configured density, in the part of the world that is seen.
void Watch::clutter(const Sensor& sensor, const Eigen::Vector3d& eye_map,
                    const Eigen::Matrix3d& map_from_sensor, Frame& frame) {
  const Eigen::Vector3d low = knowledge_.bounds_min, high = knowledge_.bounds_max;
  const double expected = sensor.clutter_density * (high - low).prod();
  for (double p = dice_.uniform(); p > std::exp(-expected); p *= dice_.uniform()) {
    Eigen::Vector3d at;
    for (int i = 0; i < 3; ++i) at[i] = dice_.uniform(low[i], high[i]);
    const int what =
        static_cast<int>(dice_.uniform(0, static_cast<double>(knowledge_.classes.size())));
    const int color = static_cast<int>(dice_.uniform(0, 11));
    if (sees(sensor, at))
      report(sensor, what, color, false, map_from_sensor.transpose() * (at - eye_map), frame);
  }
}

void Watch::report(const Sensor& sensor, int object_class, int color, bool real,
                   const Eigen::Vector3d& measured, Frame& frame) {
  const auto a = static_cast<std::size_t>(knowledge_.class_attribute);
  if (real && !sensor.confusion.empty() && !sensor.confusion[a].empty())
    object_class = draw(sensor.confusion[a][static_cast<std::size_t>(object_class)]);
  const auto& colors =
      knowledge_.attributes[static_cast<std::size_t>(knowledge_.find_attribute("color"))].symbols;
  if (!dice_.happens(kColorRight)) color = static_cast<int>(dice_.uniform(0, 11));
  Detection detection;
  detection.measurement = CartesianMeasurement{{measured.x(), measured.y(), measured.z()}, {}};
  detection.score = real ? dice_.uniform(0.6, 0.98) : dice_.uniform(0.1, 0.6);
  // In the order of their names, as JSON gives them back: both encodings are one frame then.
  const std::string& name = knowledge_.classes[static_cast<std::size_t>(object_class)].name;
  detection.attributes = {
      {"class", SymbolReport{{{name, 0.9}}}},
      {"color", SymbolReport{{{colors[static_cast<std::size_t>(color)], 0.8}}}}};
  frame.detections.push_back(std::move(detection));
}

int Watch::draw(const std::vector<double>& probabilities) {
  double left = dice_.uniform();
  for (std::size_t i = 0; i < probabilities.size(); ++i)
    if ((left -= probabilities[i]) < 0) return static_cast<int>(i);
  return static_cast<int>(probabilities.size()) - 1;
}

}  // namespace anchord::experiment
