#include "tools/anchor_tune/knowledge_parts.h"

#include <algorithm>

namespace anchord::tuning {

int single_model(const ObjectClass& c) {
  int only = -1;
  for (std::size_t m = 0; m < c.models.size(); ++m) {
    if (!c.models[m].tracked() || !c.models[m].detectable) continue;
    if (only >= 0) return -1;
    only = static_cast<int>(m);
  }
  return only;
}

nlohmann::json models_json(const std::vector<BehaviourModel>& models, const Knowledge& knowledge) {
  nlohmann::json out = nlohmann::json::array();
  for (const BehaviourModel& m : models) {
    if (m.implied) continue;
    nlohmann::json& one = out.emplace_back();
    one["kind"] = to_string(m.kind);
    if (!m.detectable) one["detectable"] = false;
    if (!m.tracked()) {
      one["rate"] = m.rate;
      if (m.place >= 0) one["place"] = knowledge.places[static_cast<std::size_t>(m.place)].name;
      continue;
    }
    one["initial_weight"] = m.initial_weight;
    if (m.kind == BehaviourModel::Kind::kConstantVelocity) {
      one["acceleration_psd"] = number(m.psd.plane);
      one["initial_velocity_variance"] = number(m.initial_velocity_variance.plane);
    } else {
      one["position_psd"] = number(m.psd.plane);
    }
    if (m.psd.vertical() != 1) one["vertical"] = number(m.psd.vertical());
  }
  return out;
}

void add_motion(const ObjectClass& c, BehaviourModel moving, const std::optional<Motion>& motion,
                bool hides, const Knowledge& knowledge, Findings& out) {
  const JsonPath at = JsonPath("/classes") / c.name, first = at / "models" / std::size_t{0};
  if (motion) moving = motion->applied_to(moving);
  std::vector<BehaviourModel> models{moving};
  if (hides) {
    models.push_back(moving);
    models[1].detectable = false;
    models[1].initial_weight = 0;
  }
  for (const BehaviourModel& m : c.models)
    if (!m.tracked()) models.push_back(m);
  out.push_back({at / "models", models_json(models, knowledge), ""});
  if (!motion) return;
  const bool velocity = moving.kind == BehaviourModel::Kind::kConstantVelocity;
  out.push_back(estimated(first / (velocity ? "acceleration_psd" : "position_psd"), motion->psd,
                          "Maximum likelihood of " + std::to_string(motion->detections) +
                              " detections on " + std::to_string(motion->tracks) + " tracks with " +
                              std::to_string(motion->gaps) + " gaps, " +
                              std::to_string(motion->strays) + " gross errors left out"));
  if (velocity)
    out.push_back(estimated(first / "initial_velocity_variance", motion->initial_velocity_variance,
                            "From the same"));
  if (motion->vertical) out.push_back(estimated(first / "vertical", *motion->vertical, "Likewise"));
}

Sensor& own_settings(Knowledge& knowledge, const std::string& name) {
  const auto it = std::find_if(knowledge.sensors.begin(), knowledge.sensors.end(),
                               [&](const Sensor& s) { return s.name == name; });
  if (it != knowledge.sensors.end()) return *it;
  knowledge.sensors.push_back(knowledge.default_sensor);
  knowledge.sensors.back().name = name;
  return knowledge.sensors.back();
}

}  // namespace anchord::tuning
