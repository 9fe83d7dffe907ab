#pragma once

#include <memory>
#include <vector>

#include "experiments/maintenance/scene.h"
#include "maintenance/site.h"
#include "maintenance/subject.h"

namespace anchord::experiment {

/// What one look of an eye brought.
struct Look {
  struct Seen {
    int thing = -1;                                      ///< that it is of; -1: clutter
    Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< measured, map frame
    int object_class = 0;                                ///< reported
  };
  int eye = 0;
  BasePose base;
  std::vector<Seen> seen;
};

/// How much is not known, nat, as in (3.13) and (3.14) of the thesis.
struct Entropies {
  double max = 0, sum = 0;
};

/// What the robot believes. Time is in seconds from the start and does not go back.
class Believer {
 public:
  virtual ~Believer() = default;
  virtual void take(const Look& look, double time) = 0;
  virtual std::vector<Subject> subjects(double time) = 0;
  virtual Entropies entropies(double time) = 0;
};

/// One Kalman filter per thing (models/kinematic.h), as in the thesis.
std::unique_ptr<Believer> kalman_believer(const Scene& scene, const Site& site, Dice& dice);

/// The engine (anchoring/world.h), fed with frames.
std::unique_ptr<Believer> engine_believer(const Scene& scene, const Site& site, Dice& dice);

}  // namespace anchord::experiment
