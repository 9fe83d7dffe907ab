#pragma once

#include "knowledge/knowledge.h"
#include "tools/anchor_tune/finding.h"
#include "tools/anchor_tune/motion.h"

namespace anchord::tuning {

/// Behaviour models as a configuration writes them, all keys said; implied ones left out.
nlohmann::json models_json(const std::vector<BehaviourModel>& models, const Knowledge& knowledge);

/// The only tracked model that is detectable, or -1 if there are several.
int single_model(const ObjectClass& c);

/// A class's models: `moving` with what was found of its motion, the same undetectable beside it
/// where it `hides`, and those that are not tracked.
void add_motion(const ObjectClass& c, BehaviourModel moving, const std::optional<Motion>& motion,
                bool hides, const Knowledge& knowledge, Findings& out);

/// The sensor's own settings, made from the default's where it has none.
Sensor& own_settings(Knowledge& knowledge, const std::string& name);

}  // namespace anchord::tuning
