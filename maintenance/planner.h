#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/verification.h"
#include "maintenance/gain.h"
#include "maintenance/viewpoint.h"

namespace anchord {

/// A look that is worth it, and why.
struct Action {
  int subject = 0;     ///< index of the object it is for
  std::string object;  ///< its id
  std::string sensor;
  BasePose viewpoint;
  double gain = 0;      ///< expected information gain of the whole action, (3.6), nat
  double cost = 0;      ///< (3.8), with the cost of the measurement
  double utility = 0;   ///< (3.9); of a look-ahead: of its whole plan
  double distance = 0;  ///< m to be driven
  double duration = 0;  ///< s
  std::vector<Glance> looks;
  Way way;
  int considered = 0;  ///< courses that were compared
};

/// What bounds the work of a choice.
struct PlannerLimits {
  int targets = 300;          ///< objects that may be set out for: of more, the vaguest
  int shared_viewpoints = 8;  ///< that see several objects, per eye
  int beam = 6;               ///< plans kept per depth
  int branches = 20;          ///< viewpoints that a plan may go on to
};

/// Which look to take next, by the configured planner; none if nothing is worth it. Deterministic.
///
/// greedy: thesis section 3.5.3. Of the actions with gain above the threshold (3.7) the one of
/// greatest utility (3.9); ties go to the first in order of subjects and eyes.
///
/// lookahead: the greedy rule counts what an action gains at its own end, however long it takes,
/// and knows no tour: it crosses the house for one object and comes back for the next. Here a plan
/// is a sequence of up to `horizon` viewpoints, and its worth the entropy it takes away, averaged
/// over the same span T = horizon * C_scale / (2 speed) for all plans,
///     U = (1/T) integral_0^T sum_o [H_o(no looks) - E H_o(looks until t)] dt / IG_norm
///         - omega sum of costs,
/// the Lagrangian of persistent monitoring at a price per metre (Smith, Schwager, Rus, "Persistent
/// robotic tasks", T-RO 2012); what is seen early counts longer. Beam search keeps the `beam` best
/// plans per depth: sequences of viewpoints are an orienteering problem, which is NP-hard. The best
/// plan's first action is taken if U > 0 (staying has 0) and its looks gain more than the
/// threshold in the mean over its viewpoints; then everything is planned anew.
std::optional<Action> choose(const std::vector<Subject>& subjects, const RobotPose& robot,
                             const Site& site, const PlannerLimits& limits = {});

/// The best look at one subject, worth it or not: what a trigger asks for. `sensor` empty: any.
/// None where no sensor can see it.
std::optional<Action> choose_for(int subject, const std::string& sensor,
                                 const std::vector<Subject>& subjects, const RobotPose& robot,
                                 const Site& site);

}  // namespace anchord
