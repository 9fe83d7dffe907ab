#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace anchord {

/// A wall: a line seen from above, between two heights, m. In a 2-D world there are no heights.
struct Wall {
  std::array<double, 2> from{}, to{};
  double z_min = -std::numeric_limits<double>::infinity();
  double z_max = std::numeric_limits<double>::infinity();
  bool operator==(const Wall&) const = default;
};

/// Walls as obstacles of ways and of sight.
class Walls {
 public:
  explicit Walls(const std::vector<Wall>& walls);

  bool none() const { return walls_.empty(); }
  /// Those that are not wholly on one side of a box in the plane {x_min, y_min, x_max, y_max}.
  Walls within(const std::array<double, 4>& box) const;
  /// Whether the straight way from a to b meets a wall of any height.
  bool between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Whether a wall stands between an eye and a point, up to 0.1 m before it: what stands at a wall
  /// may be estimated to lie in it.
  bool hide(const Eigen::Vector3d& eye, const Eigen::Vector3d& point) const;
  /// Of points one above the other, how many no wall hides, as hide() has it of each.
  int clear(const Eigen::Vector3d& eye, const Eigen::Vector2d& column,
            std::span<const double> heights) const;

 private:
  /// Whether the stretch from a over e meets a wall, and how far along, 0 to 1; touching counts.
  struct Meeting {
    bool met = false;
    double at = 0;
  };
  static Meeting meet(const Wall& wall, const Eigen::Vector2d& a, const Eigen::Vector2d& e);

  std::vector<Wall> walls_;
};

/// Most walls that a world may have.
inline constexpr std::size_t kMaxWalls = 200;

}  // namespace anchord
