#include <algorithm>
#include <cmath>

#include "geometry/conversion.h"
#include "knowledge/configuration_reader.h"

namespace anchord {
namespace {

constexpr std::size_t kMostActions = 1000;
constexpr Range kSeconds{0, 1e6};
constexpr Range kSomeSeconds{0, 1e6, true};
constexpr Range kGain{-1e6, 1e6};

void read_actions(const JsonValue& value, Maintenance& maintenance) {
  maintenance.actions.clear();
  for (const JsonValue& entry : value.elements(kMostActions)) {
    if (!entry.object_of({"action", "verify"})) continue;
    Maintenance::ActionRule rule;
    if (const auto action = entry.find("action")) {
      rule.action = action->name().value_or("");
      const bool known =
          std::any_of(maintenance.actions.begin(), maintenance.actions.end(),
                      [&](const auto& other) { return other.action == rule.action; });
      if (known && !rule.action.empty()) action->mistake("is there already");
    } else {
      entry.mistake_at(entry.path_of("action"), "is missing");
    }
    if (const auto verify = entry.find("verify")) {
      const auto what = verify->one_of({"object", "none"}, "thing to verify");
      rule.verify = what == 1 ? Maintenance::Verify::kNothing : Maintenance::Verify::kObject;
    } else {
      entry.mistake_at(entry.path_of("verify"), R"(is missing; it must be "object" or "none")");
    }
    maintenance.actions.push_back(std::move(rule));
  }
}

/// The sensor in the robot's base.
void read_mount(const JsonValue& value, Pose& mount) {
  if (!value.object_of({"position", "orientation"})) return;
  if (const auto position = value.find("position")) {
    if (const auto x = position->numbers(3, kCoordinate))
      std::copy(x->begin(), x->end(), mount.position.begin());
  }
  if (const auto orientation = value.find("orientation")) {
    const auto q = orientation->numbers(4);
    if (!q) return;
    std::copy(q->begin(), q->end(), mount.orientation.begin());
    if (const Status checked = check_pose(mount); !checked)
      orientation->mistake(checked.error().message);
  }
}

}  // namespace

void read_maintenance(const JsonValue& root, Knowledge& knowledge) {
  Maintenance& maintenance = knowledge.maintenance;
  const Eigen::Vector3d size = knowledge.bounds_max - knowledge.bounds_min;
  maintenance.cost_scale = size.norm();  // z is 0 in a 2-D world
  const auto section = root.find("maintenance");
  if (!section) return;
  if (!section->object_of({"planner", "threshold", "omega", "gain_norm", "cost_scale", "speed",
                           "step", "clearance", "horizon", "timeout", "enabled", "actions"})) {
    return;
  }
  if (const auto planner = section->find("planner")) {
    const auto which = planner->one_of({"greedy", "lookahead"}, "planner");
    maintenance.planner =
        which == 1 ? Maintenance::Planner::kLookahead : Maintenance::Planner::kGreedy;
  }
  section->read("threshold", maintenance.threshold, kGain);
  section->read("omega", maintenance.omega, kNotNegative);
  section->read("gain_norm", maintenance.gain_norm, kPositive);
  section->read("cost_scale", maintenance.cost_scale, kPositive);
  section->read("speed", maintenance.speed, {1e-3, 1e3});
  section->read("step", maintenance.step, {1e-3, 1e3});
  section->read("clearance", maintenance.clearance, {0, 100});
  section->read("horizon", maintenance.horizon, 1, 20);
  section->read("timeout", maintenance.timeout, kSomeSeconds);
  section->read("enabled", maintenance.enabled);
  if (const auto actions = section->find("actions")) read_actions(*actions, maintenance);
}

void read_verification(const JsonValue& value, const Knowledge& knowledge,
                       Verification& verification) {
  if (!value.object_of({"mount", "moves_base", "cost", "dwell", "noise"})) return;
  if (const auto mount = value.find("mount")) read_mount(*mount, verification.mount);
  value.read("moves_base", verification.moves_base);
  value.read("cost", verification.cost, kNotNegative);
  value.read("dwell", verification.dwell, kSeconds);
  const auto noise = value.find("noise");
  if (!noise || !noise->object()) return;
  std::vector<std::string> known;
  for (const ObjectClass& object_class : knowledge.classes) known.push_back(object_class.name);
  if (const auto rest = noise->find("default")) {
    if (const auto covariance = rest->covariance(knowledge.dims))
      verification.noise.assign(known.size(), *covariance);
  }
  for (const auto& [name, entry] : noise->members()) {
    if (name == "default") continue;
    const auto index = entry.index_of(name, known, "class");
    const auto covariance = index ? entry.covariance(knowledge.dims) : std::nullopt;
    if (covariance) verification.noise[static_cast<std::size_t>(*index)] = *covariance;
  }
}

void finish_verification(const JsonValue& value, Sensor& sensor) {
  if (!sensor.verification) return;
  const std::string path = value.path_of("verification");
  if (!sensor.view || sensor.view->type == View::Type::kNone)
    value.mistake_at(path, "needs a \"view\" of the sensor that sees something");
  bool complete = true;
  for (auto& noise : sensor.verification->noise) {
    if (noise.empty()) noise = sensor.noise;
    complete = complete && !noise.empty();
  }
  if (!complete)
    value.mistake_at(path + ".noise",
                     "is missing for some class, and the sensor has no position covariance in its "
                     "own \"noise\"; \"default\" stands for those not named");
}

}  // namespace anchord
