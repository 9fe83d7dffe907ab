#include "api/scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "api/verification_json.h"

namespace anchord {
namespace {

using nlohmann::json;

constexpr double kWeight = 1e-2;  // of a somewhere that is told of
constexpr std::int64_t kSecond = 1'000'000;

/// To so many digits after the point, as one writes it: 0.3, not 0.30000000000000004.
double number(double x, int digits) {
  const double scale = std::pow(10, digits);
  return std::round(x * scale) / scale;
}

/// To two significant digits.
double rough(double x) {
  return x == 0 ? 0 : number(x, 1 - static_cast<int>(std::floor(std::log10(std::abs(x)))));
}

json position_of(const Gaussian& where, int dims) {
  json out = json::array();
  for (int i = 0; i < dims; ++i) out.push_back(number(where.mean[i], 3));
  return out;
}

json triangle_of(const Gaussian& where, int dims) {
  json out = json::array();
  for (int i = 0; i < dims; ++i)
    for (int j = i; j < dims; ++j) out.push_back(rough(where.covariance(i, j)));
  return out;
}

/// The weight of what is tracked of a leaf; the rest is somewhere.
double tracked_weight(const Leaf& leaf) {
  double sum = 0;
  for (const ModelState& model : leaf.models)
    if (std::holds_alternative<Kinematic>(model.density)) sum += model.weight;
  return sum;
}

json attributes_of(const Leaf& leaf, const Background& background) {
  json out = json::object();
  for (const AttributeBelief& belief : leaf.attributes) {
    const Attribute& attribute = background.knowledge.attributes[belief.attribute];
    if (attribute.kind == Attribute::Kind::kScalar) {
      out[attribute.name] = number(belief.mean, 3);
      continue;
    }
    const auto likeliest = std::max_element(belief.symbols.begin(), belief.symbols.end());
    out[attribute.name] = attribute.symbols[likeliest - belief.symbols.begin()];
  }
  return out;
}

json object_of(const ObjectBelief& object, const Background& background) {
  const int dims = background.dims;
  const Leaf& leaf = object.shown();
  const double somewhere = 1 - tracked_weight(leaf);
  Gaussian where;
  if (somewhere < 0.5) {
    const Kinematic& tracked = ::anchord::position_of(leaf);
    where = {tracked.position, tracked.pp};
  } else {
    where = object.moments(background);
  }
  json out{{"class", background.object_class(leaf.top_class()).name},
           {"p", number(object.p, 3)},
           {"position", position_of(where, dims)},
           {"covariance", triangle_of(where, dims)},
           {"seen", leaf.last_seen / kSecond}};
  if (somewhere >= kWeight) out["somewhere"] = number(somewhere, 2);
  if (json attributes = attributes_of(leaf, background); !attributes.empty())
    out["attributes"] = std::move(attributes);
  if (const int place = object.place(background); place >= 0)
    out["place"] = background.knowledge.places[place].name;
  const Eigen::Vector3d& extent = background.object_class(leaf.top_class()).extent;
  if (!extent.isZero()) out["extent"] = {extent.x(), extent.y(), extent.z()};
  if (leaf.yaw) out["yaw"] = number(*leaf.yaw, 2);
  if (!object.anchor->alias.empty()) out["alias"] = object.anchor->alias;
  if (object.anchor->holder) out["held_by"] = *object.anchor->holder;
  return out;
}

json task_of(const Task& task) {
  json out{{"state", to_string(task.state)}, {"object", task.object}, {"reason", task.reason}};
  if (!task.robot.empty()) out["robot"] = task.robot;
  if (!task.sensor.empty()) out["sensor"] = task.sensor;
  if (task.viewpoint) {
    out["viewpoint"] = {{"position", task.viewpoint->position},
                        {"orientation", task.viewpoint->orientation}};
    out["gain"] = number(task.gain_nat, 3);
    out["cost"] = number(task.cost, 3);
  }
  return out;
}

json robot_of(const RobotPose& robot) {
  json position = json::array(), orientation = json::array();
  for (const double x : robot.pose.position) position.push_back(number(x, 3));
  for (const double x : robot.pose.orientation) orientation.push_back(number(x, 4));
  return {{"position", std::move(position)}, {"orientation", std::move(orientation)}};
}

}  // namespace

json scene_json(const Snapshot& snapshot, const SceneParts& parts) {
  const Background& background = *snapshot.background;
  const Belief& belief = *snapshot.belief;
  json objects = json::object(), tasks = json::object(), robots = json::object();
  double expected = 0;
  for (const auto& object : read_objects(belief, snapshot.utime(), 0, background)) {
    expected += object.p;
    if (object.in_best) objects[object.anchor->id()] = object_of(object, background);
  }
  for (const Task& task : parts.tasks) tasks[std::to_string(task.id)] = task_of(task);
  for (const RobotPose& robot : parts.robots) robots[robot.robot] = robot_of(robot);
  std::size_t hypotheses = 0;
  for (const auto& cluster : belief.clusters) hypotheses += cluster->hypotheses.size();
  return {{"utime", snapshot.utime()},     {"expected_count", number(expected, 2)},
          {"hypotheses", hypotheses},      {"clusters", belief.clusters.size()},
          {"objects", std::move(objects)}, {"tasks", std::move(tasks)},
          {"robots", std::move(robots)}};
}

}  // namespace anchord
