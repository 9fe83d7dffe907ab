#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "anchoring/world.h"

namespace anchord::experiment {

/// Folds a simulated frame, which the engine cannot refuse.
void take(World& world, const Frame& frame);

/// An object of the best world; its leaf belongs to the belief.
struct Shown {
  std::uint64_t birth = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  const Leaf* leaf = nullptr;
};

/// The best world.
std::vector<Shown> best_world(const Belief& belief);

/// The one of `shown` nearest to a place, if it is within `radius` (m); else null.
const Shown* nearest(const std::vector<Shown>& shown, const Eigen::Vector2d& place, double radius);

/// That an anchor stands within `radius` of a place.
struct Standing {
  std::uint64_t birth = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

/// P(all of these hold), over all hypotheses.
double probability_of(const Belief& belief, const std::vector<Standing>& all, double radius);

/// Every anchor there is, by birth.
std::vector<std::uint64_t> anchors(const Belief& belief);

}  // namespace anchord::experiment
