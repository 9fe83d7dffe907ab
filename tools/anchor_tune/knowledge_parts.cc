#include "tools/anchor_tune/knowledge_parts.h"

#include <algorithm>

namespace anchord::tuning {

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

Sensor& own_settings(Knowledge& knowledge, const std::string& name) {
  const auto it = std::find_if(knowledge.sensors.begin(), knowledge.sensors.end(),
                               [&](const Sensor& s) { return s.name == name; });
  if (it != knowledge.sensors.end()) return *it;
  knowledge.sensors.push_back(knowledge.default_sensor);
  knowledge.sensors.back().name = name;
  return knowledge.sensors.back();
}

}  // namespace anchord::tuning
