#pragma once

#include <optional>
#include <vector>

#include "maintenance/planner.h"

namespace anchord {

/// The choice of Maintenance::Planner::kLookahead; see choose().
std::optional<Action> choose_lookahead(const std::vector<Subject>& subjects, const BasePose& from,
                                       const Site& site, const PlannerLimits& limits);

}  // namespace anchord
