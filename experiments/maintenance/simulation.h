#pragma once

#include <cstdint>
#include <vector>

#include "experiments/maintenance/scene.h"
#include "maintenance/planner.h"

namespace anchord::experiment {

/// What decides where the robot goes next; the planner's settings are in the scene's knowledge.
struct Strategy {
  enum class Kind {
    kTour,     ///< from object to object in order of their numbers, over and over
    kPlanner,  ///< maintenance/planner.h
    kPatrol,   ///< round Scene::patrol, at each place looking about by quarter turns
    kPresent   ///< the greedy rule, the gain counted from what is known now, not from what would
               ///< be known without the looks: the other reading of thesis (3.6)
  };
  Kind kind = Kind::kPlanner;
  PlannerLimits limits{.shared_viewpoints = 0};  ///< the thesis has one action per object
  int eye = 0;                                   ///< of the tour
  double pause = 0;         ///< s that a tour rests, or a patrol looks about, after each action
  bool looks_idle = false;  ///< looks also while there is no action
};

/// Of one simulation.
struct Outcome {
  double h_max = 0, h_sum = 0;  ///< nat, means over the time steps from `warm_up` on
  double distance = 0;          ///< m, from `warm_up` on
  int actions = 0, updates = 0;
  std::vector<int> updated, approached;  ///< per thing
  double cost = 0;                       ///< (3.8) of all actions
  double lost = 0;  ///< share of things of which nothing is believed within 1 m, mean over time
};

struct Span {
  double length = 1000;  ///< s
  double warm_up = 0;    ///< s at the beginning that do not count
  double step = 1;       ///< s
  int sample = 1;        ///< steps from one reading of the entropy to the next
};

/// Runs one simulation; the same arguments give the same outcome to the bit.
Outcome simulate(Scene scene, const Strategy& strategy, const Span& span, std::uint64_t seed);

}  // namespace anchord::experiment
