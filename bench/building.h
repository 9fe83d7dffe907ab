#pragma once

#include <Eigen/Core>
#include <vector>

#include "bench/crowd.h"

namespace anchord::bench {

/// A building of rooms of about 6 x 5 m, about as wide as long, with things at rest in it, evenly
/// spread from the floor to 2 m. A robot drives through it along straight lanes and looks ahead, 6
/// m far and 90 degrees wide: it reports 100 things at once. Nothing hides another; walls are left
/// out.
class Building {
 public:
  Building(int things, const Knowledge& classes, std::uint64_t seed);

  /// The classes' knowledge, with this building's bounds.
  const Knowledge& knowledge() const { return knowledge_; }

  int rooms() const { return columns_ * rows_; }
  /// Everything in a room, each thing detected for certain.
  Frame inspect(int room);
  /// What the robot sees `step` steps (0.2 s, 0.1 m) after it has set out.
  Frame look(int step);

 private:
  struct Thing {
    Eigen::Vector3d position;
    int what, color;
  };
  Detection detect(const Thing& thing);
  Detection clutter(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  Pose pose(int step) const;

  Knowledge knowledge_;
  Dice dice_;
  int columns_ = 0, rows_ = 0;
  double length_ = 0, width_ = 0;           // of a room, m
  std::vector<std::vector<Thing>> things_;  // by room
  Utime now_ = 1'700'000'000'000'000;
};

}  // namespace anchord::bench
