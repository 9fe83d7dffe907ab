#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/dice.h"
#include "experiments/rectangle.h"
#include "knowledge/knowledge.h"

namespace anchord::experiment {

/// A real object.
struct Thing {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  int object_class = 0;
  double psd = 0;  ///< m^2/s, of what is believed of its motion
};

/// A world to simulate: what is known of it, and what is true.
struct Scene {
  Knowledge knowledge;
  std::vector<Rectangle> rooms;  ///< where things may be
  std::vector<Thing> things;
  std::vector<Eigen::Vector2d> patrol;              ///< places of a good round, if one is known
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< of the robot
  double initial_variance = 0.01;                   ///< m^2 per axis, of what is believed at first
  bool wanders = false;  ///< things do move as is believed, each within its room
  double jump_rate = 0;  ///< 1/s at which a thing is carried to anywhere
  double approach = 0;   ///< m from an object at which the robot stands; 0: the planner's own
  bool engine = false;   ///< the belief is the engine's, from detections without identity; else one
                         ///< Kalman filter for each thing, its detections told apart
};

/// The room of thesis section 3.7.1. Dimensions, width of view, step and speed are not said there:
/// these were chosen so that the fixed tour has about its 263 actions and 973 updates.
struct RoomOptions {
  int dims = 2;
  int things = 10;
  double most_psd = 0.01;   ///< m^2/s: each thing's is drawn from [0, most_psd]
  double half_width = 1.7;  ///< rad, of what the sensor sees to both sides
  double step = 1;          ///< s
  double speed = 1.055;     ///< m/s
};
Scene thesis_room(const RoomOptions& options, Dice& dice);

/// The same room with detections that miss, clutter, and things that are carried about.
Scene unreliable_room(Dice& dice);

/// Forty things in five rooms of 18 x 12 m, and two sensors: `far` (0.5 to 5 m, 90 degrees wide,
/// standard deviation 0.3 m) and `near` (0.3 to 1.5 m, 90 degrees, 0.05 m, takes 2 s and costs
/// as much as 1.8 m of driving). Each thing's psd is drawn from [0, most_psd].
Scene house(double most_psd, Dice& dice);

}  // namespace anchord::experiment
