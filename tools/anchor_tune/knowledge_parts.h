#pragma once

#include "knowledge/knowledge.h"
#include "tools/anchor_tune/finding.h"

namespace anchord::tuning {

/// Behaviour models as a configuration writes them, all keys said; implied ones left out.
nlohmann::json models_json(const std::vector<BehaviourModel>& models, const Knowledge& knowledge);

/// The sensor's own settings, made from the default's where it has none.
Sensor& own_settings(Knowledge& knowledge, const std::string& name);

}  // namespace anchord::tuning
