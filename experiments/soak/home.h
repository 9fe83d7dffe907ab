#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/time.h"
#include "experiments/dice.h"
#include "maintenance/site.h"

namespace anchord::experiment {

/// A real object that does not move by itself.
struct HomeThing {
  int object_class = 0;
  int color = 0;                                       ///< symbol of the attribute `color`
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< map frame, m
  int carrier = -1;                                    ///< the dweller in whose hands it is
  double returns = 0;  ///< s from the start, when it comes out of the cupboard; 0: it is out
  bool here() const { return returns == 0; }
};

/// Somebody who moves by themselves: who lives here, visits, or is the cat.
struct Dweller {
  int object_class = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< map frame, m
  double height = 0;                                   ///< m, of the body's middle
  double speed = 1;                                    ///< m/s
  double rest = 180, away = 3600;  ///< s, means: between two ways, and out of the home
  double leaves = 0;               ///< probability that a way leads out of the door
  int color = 0;                   ///< of what they wear
  bool here = true;
  double until = 0;                  ///< s from the start, when they get up, or come home
  std::vector<Eigen::Vector2d> way;  ///< points that are still before them, the next one last
  int carries = -1;                  ///< the thing in their hands
  Eigen::Vector3d puts = {0, 0, 0};  ///< where it will be put
};

/// A home and what really goes on in it: people walk between rooms, leave, come back and have
/// visitors; they carry cups and other small things from surface to surface, and put some away for
/// a while. A cat walks about. The same seed gives the same to the bit.
class Home {
 public:
  /// The knowledge is that of config/home.json: its classes, places, walls and door.
  Home(const Knowledge& knowledge, const Site& site, std::uint64_t seed);

  /// Lets `dt` seconds go by.
  void step(double dt);
  double seconds() const { return now_; }
  const std::vector<HomeThing>& things() const { return things_; }
  const std::vector<Dweller>& dwellers() const { return dwellers_; }

 private:
  void furnish();
  void get_up(int who);
  void arrive(int who);
  void walk(Dweller& dweller, double most);
  void set_out(Dweller& dweller, const Eigen::Vector2d& to);
  void take_along(int who);
  Eigen::Vector3d spot(const std::string& place);
  double after(double mean);

  const Knowledge& knowledge_;
  const Site& site_;
  Dice dice_;
  double now_ = 0;
  std::vector<HomeThing> things_;
  std::vector<Dweller> dwellers_;
};

}  // namespace anchord::experiment
