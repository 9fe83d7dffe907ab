#include "experiments/anchoring/ants.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bench/identity.h"
#include "experiments/anchoring/watching.h"

namespace anchord::experiment {
namespace {

constexpr Utime kStart = 1'700'000'000'000'000;  // any time that a frame may carry
constexpr double kPaired = 0.002;                // m: an ant and what stands for it
const Eigen::Vector2d kMiddle{0.04435, 0.03325};

struct Ant {
  Eigen::Vector2d position;
  double heading = 0, log_speed = 0, diameter = 0;  // log_speed: to the median

  void walk(const Dish& dish, double dt, Dice& dice) {
    const double keeps = std::exp(-dt / dish.speed_time);
    log_speed =
        keeps * log_speed + std::sqrt(1 - keeps * keeps) * dish.speed_deviation * dice.normal();
    heading += dish.turning * std::sqrt(dt) * dice.normal();
    const Eigen::Vector2d way{std::cos(heading), std::sin(heading)};
    const Eigen::Vector2d to = position + dish.speed * std::exp(log_speed) * dt * way;
    if ((to - kMiddle).norm() > dish.radius)  // towards the middle, more or less
      heading = std::atan2(kMiddle.y() - to.y(), kMiddle.x() - to.x()) + dice.normal();
    else
      position = to;
  }
};

/// Groups of ants that are linked by steps shorter than a body.
std::vector<std::vector<const Ant*>> contacts(const std::vector<Ant>& ants, double body) {
  std::vector<int> group(ants.size());
  std::iota(group.begin(), group.end(), 0);
  for (std::size_t i = 0; i < ants.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((ants[i].position - ants[j].position).norm() < body)
        std::replace(group.begin(), group.end(), std::max(group[i], group[j]),
                     std::min(group[i], group[j]));
  std::vector<std::vector<const Ant*>> all(ants.size());
  for (std::size_t i = 0; i < ants.size(); ++i)
    all[static_cast<std::size_t>(group[i])].push_back(&ants[i]);
  std::erase_if(all, [](const auto& members) { return members.empty(); });
  return all;
}

Detection blob(const std::vector<const Ant*>& members, const Dish& dish, Dice& dice) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double square = 0;
  for (const Ant* ant : members) {
    middle += ant->position / static_cast<double>(members.size());
    square += ant->diameter * ant->diameter;
  }
  const double v = dish.noise * dish.noise, size = std::sqrt(square);
  Detection detection;
  const double x = middle.x() + dish.noise * dice.normal();
  detection.measurement =
      CartesianMeasurement{{x, middle.y() + dish.noise * dice.normal()}, {v, 0, 0, v}};
  const double deviation = dish.size_noise * size;
  detection.attributes.push_back(
      {"size", ScalarReport{size + deviation * dice.normal(), deviation * deviation}});
  return detection;
}

}  // namespace

std::vector<AntsShot> simulate_ants(const Dish& dish, Dice& dice) {
  std::vector<Ant> ants(static_cast<std::size_t>(dish.ants));
  for (Ant& ant : ants) {
    const double r = dish.radius * std::sqrt(dice.uniform());
    const double angle = dice.uniform(0, 2 * std::numbers::pi);
    ant.position = kMiddle + r * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    ant.heading = dice.uniform(0, 2 * std::numbers::pi);
    ant.log_speed = dish.speed_deviation * dice.normal();
    ant.diameter = dice.uniform(dish.least_diameter, dish.most_diameter);
  }
  std::vector<AntsShot> shots;
  for (int k = 0; k < dish.seconds * dish.rate_hz; ++k) {
    AntsShot& shot = shots.emplace_back();
    shot.time = k / dish.rate_hz;
    shot.frame.utime = kStart + from_seconds(shot.time);
    shot.frame.sensor = "camera";
    shot.frame.view.emplace().type = View::Type::kWorld;
    for (Ant& ant : ants) {
      if (k > 0) ant.walk(dish, 1 / dish.rate_hz, dice);
      shot.truth.push_back(ant.position);
    }
    for (const auto& members : contacts(ants, dish.body))
      if (dice.happens(dish.detection_probability))
        shot.frame.detections.push_back(blob(members, dish, dice));
    const auto x = [](const Detection& d) {
      return std::get<CartesianMeasurement>(d.measurement).position[0];
    };
    std::sort(shot.frame.detections.begin(), shot.frame.detections.end(),
              [&](const Detection& a, const Detection& b) { return x(a) < x(b); });
  }
  return shots;
}

std::vector<AntsBelief> watch_ants(const Knowledge& knowledge, const std::vector<AntsShot>& shots) {
  World world(knowledge);
  bench::IdentityCount identity(kPaired);
  std::vector<AntsBelief> beliefs;
  for (const AntsShot& shot : shots) {
    take(world, shot.frame);
    AntsBelief& belief = beliefs.emplace_back();
    for (const auto& cluster : world.belief()->clusters)
      for (std::size_t a = 0; a < cluster->anchors.size(); ++a)
        belief.expected += cluster->existence(static_cast<int>(a), *world.background());
    std::vector<bench::Track> tracks;
    for (const Shown& shown : best_world(*world.belief()))
      tracks.push_back({shown.birth, shown.position});
    belief.shown = static_cast<int>(tracks.size());
    identity.add(shot.truth, tracks);
    belief.names = identity.paired();
  }
  return beliefs;
}

}  // namespace anchord::experiment
