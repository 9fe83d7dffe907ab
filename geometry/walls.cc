#include "geometry/walls.h"

#include <algorithm>
#include <boost/container/small_vector.hpp>

namespace anchord {
namespace {

constexpr double kDepth = 0.1;  // m, see Walls::hide()

}  // namespace

Walls::Walls(const std::vector<Wall>& walls) : walls_(walls) {}

Walls Walls::within(const std::array<double, 4>& box) const {
  std::vector<Wall> kept;
  for (const Wall& wall : walls_) {
    const auto beside = [&](int axis) {
      const auto [low, high] = std::minmax(wall.from[axis], wall.to[axis]);
      return high < box[axis] || low > box[axis + 2];
    };
    if (!beside(0) && !beside(1)) kept.push_back(wall);
  }
  return Walls(kept);
}

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
  return clear(eye, point.head<2>(), {&point.z(), 1}) == 0;
}

int Walls::clear(const Eigen::Vector3d& eye, const Eigen::Vector2d& column,
                 std::span<const double> heights) const {
  const int all = static_cast<int>(heights.size());
  const Eigen::Vector2d from_eye = column - eye.head<2>();
  const double length = from_eye.norm();
  if (walls_.empty() || length <= kDepth) return all;
  const double stretch = 1 - kDepth / length;
  const Eigen::Vector2d e = stretch * from_eye;
  boost::container::small_vector<double, 8> left(heights.begin(), heights.end());
  for (const Wall& wall : walls_) {
    const Meeting meeting = meet(wall, eye.head<2>(), e);
    if (!meeting.met) continue;
    const auto hidden = [&](double height) {
      const double z = eye.z() + meeting.at * stretch * (height - eye.z());
      return z >= wall.z_min && z <= wall.z_max;
    };
    left.erase(std::remove_if(left.begin(), left.end(), hidden), left.end());
    if (left.empty()) return 0;
  }
  return static_cast<int>(left.size());
}

}  // namespace anchord
