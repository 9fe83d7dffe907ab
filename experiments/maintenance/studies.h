#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/maintenance/simulation.h"

namespace anchord::experiment {

/// One point of a curve: a strategy in a kind of scene, with one setting that varies.
struct Point {
  std::string study, variant, strategy;  ///< of which curve
  double value = 0;                      ///< of what varies along it
  std::function<Scene(Dice&)> scene;
  Strategy how;
  Span span;
  int runs_share = 1;  ///< one run of so many is made
};

/// Names of the studies, in order.
const std::vector<std::string>& study_names();

/// The points of a study; none if there is no such study.
std::vector<Point> points_of(const std::string& study);

}  // namespace anchord::experiment
