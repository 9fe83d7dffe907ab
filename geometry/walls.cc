#include "geometry/walls.h"

#include <algorithm>

namespace anchord {
namespace {

constexpr double kDepth = 0.1;  // m, see Walls::hide()

}  // namespace

Walls::Walls(const std::vector<Wall>& walls) : walls_(walls) {}

Walls::Meeting Walls::meet(const Wall& wall, const Eigen::Vector2d& a, const Eigen::Vector2d& e) {
  const double dx = wall.to[0] - wall.from[0], dy = wall.to[1] - wall.from[1];
  // Each line's ends on different sides of the other.
  const double ax = a.x() - wall.from[0], ay = a.y() - wall.from[1];
  const double side_a = dx * ay - dy * ax;
  const double side_b = side_a + dx * e.y() - dy * e.x();
  if (side_a * side_b > 0) return {};
  const double start = e.y() * ax - e.x() * ay;
  const double end = start + e.x() * dy - e.y() * dx;
  if (start * end > 0) return {};
  if (side_a != 0 || side_b != 0) return {true, side_a / (side_a - side_b)};
  // On one line: whether the stretches overlap.
  const double length2 = dx * dx + dy * dy;
  const double at = (dx * ax + dy * ay) / length2;
  const double to = at + (dx * e.x() + dy * e.y()) / length2;
  return {std::max(at, to) >= 0 && std::min(at, to) <= 1, 1};
}

bool Walls::between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  return std::any_of(walls_.begin(), walls_.end(),
                     [&](const Wall& wall) { return meet(wall, a, b - a).met; });
}

bool Walls::hide(const Eigen::Vector3d& eye, const Eigen::Vector3d& point) const {
  const double length = (point - eye).head<2>().norm();
  if (walls_.empty() || length <= kDepth) return false;
  const Eigen::Vector3d e = (1 - kDepth / length) * (point - eye);
  return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& wall) {
    const Meeting meeting = meet(wall, eye.head<2>(), e.head<2>());
    const double z = eye.z() + meeting.at * e.z();
    return meeting.met && z >= wall.z_min && z <= wall.z_max;
  });
}

}  // namespace anchord
