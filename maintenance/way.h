#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "geometry/walls.h"

namespace anchord {

/// A way on the floor: straight lines from point to point.
struct Way {
  std::vector<Eigen::Vector2d> points;                      ///< first and last included
  double length = std::numeric_limits<double>::infinity();  ///< m; infinite: there is none
};

/// Shortest ways around walls: the straight line where nothing is in its way, else along the
/// visibility graph (Lozano-Perez and Wesley, 1979) whose nodes stand off the ends of the walls by
/// the clearance. Distances between nodes are computed once. It is an estimate of what a robot
/// drives: its own planner finds the way.
class WayMap {
 public:
  /// Nodes outside the bounds are left out.
  WayMap(const std::vector<Wall>& walls, double clearance, const Eigen::Vector2d& bounds_min,
         const Eigen::Vector2d& bounds_max);

  const Walls& walls() const { return walls_; }

  /// A place from which ways begin, with what can be known beforehand.
  struct Start {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    std::vector<double> distance;  ///< to each node, m
    std::vector<int> first;        ///< the node seen from here by which it goes there
    std::vector<int> order;        ///< nodes that can be reached, nearest first
  };
  Start start(const Eigen::Vector2d& position) const;

  /// m; infinite where there is no way.
  double length(const Start& from, const Eigen::Vector2d& to) const;
  Way way(const Start& from, const Eigen::Vector2d& to) const;

 private:
  struct Arrival {
    double length;
    int node;  ///< the last before the end; -1: straight
  };
  Arrival arrive(const Start& from, const Eigen::Vector2d& to) const;
  double& distance(int a, int b) { return distance_[a * nodes_.size() + b]; }

  Walls walls_;
  std::vector<Eigen::Vector2d> nodes_;
  std::vector<double> distance_;  ///< between all pairs of nodes
  std::vector<int> next_;         ///< from a towards b
};

}  // namespace anchord
