#include "maintenance/way.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anchord {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Walls::Walls(const std::vector<Wall>& walls) {
  for (const Wall& wall : walls) {
    x0_.push_back(wall.from[0]);
    y0_.push_back(wall.from[1]);
    dx_.push_back(wall.to[0] - wall.from[0]);
    dy_.push_back(wall.to[1] - wall.from[1]);
  }
}

bool Walls::between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  const double ex = b.x() - a.x(), ey = b.y() - a.y();
  for (std::size_t i = 0; i < x0_.size(); ++i) {
    // Each line's ends on different sides of the other; touching counts.
    const double ax = a.x() - x0_[i], ay = a.y() - y0_[i];
    const double side_a = dx_[i] * ay - dy_[i] * ax;
    const double side_b = side_a + dx_[i] * ey - dy_[i] * ex;
    if (side_a * side_b > 0) continue;
    const double start = ey * ax - ex * ay;
    const double end = start + ex * dy_[i] - ey * dx_[i];
    if (start * end > 0) continue;
    if (side_a != 0 || side_b != 0) return true;
    // On one line: whether the stretches overlap.
    const double length2 = dx_[i] * dx_[i] + dy_[i] * dy_[i];
    const double at = (dx_[i] * ax + dy_[i] * ay) / length2;
    const double to = at + (dx_[i] * ex + dy_[i] * ey) / length2;
    if (std::max(at, to) >= 0 && std::min(at, to) <= 1) return true;
  }
  return false;
}

WayMap::WayMap(const std::vector<Wall>& walls, double clearance, const Eigen::Vector2d& bounds_min,
               const Eigen::Vector2d& bounds_max)
    : walls_(walls) {
  const auto add = [&](const Eigen::Vector2d& node) {
    if ((node.array() <= bounds_min.array()).any() || (node.array() >= bounds_max.array()).any())
      return;
    for (const Eigen::Vector2d& other : nodes_)
      if ((other - node).norm() < 0.1 * clearance) return;
    nodes_.push_back(node);
  };
  for (const Wall& wall : walls) {
    const Eigen::Vector2d from(wall.from[0], wall.from[1]), to(wall.to[0], wall.to[1]);
    const Eigen::Vector2d along = clearance * (to - from).normalized();
    const Eigen::Vector2d across(-along.y(), along.x());
    for (const Eigen::Vector2d& end : {Eigen::Vector2d(from - along), Eigen::Vector2d(to + along)})
      for (const double side : {-1.0, 1.0}) add(end + side * across);
  }
  const int n = static_cast<int>(nodes_.size());
  distance_.assign(static_cast<std::size_t>(n) * n, kInfinity);
  next_.assign(distance_.size(), -1);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      if (a == b || !walls_.between(nodes_[a], nodes_[b])) {
        distance(a, b) = (nodes_[a] - nodes_[b]).norm();
        next_[a * n + b] = b;
      }
  // Floyd and Warshall's algorithm.
  for (int k = 0; k < n; ++k)
    for (int a = 0; a < n; ++a) {
      const double there = distance(a, k);
      if (there == kInfinity) continue;
      for (int b = 0; b < n; ++b)
        if (there + distance(k, b) < distance(a, b)) {
          distance(a, b) = there + distance(k, b);
          next_[a * n + b] = next_[a * n + k];
        }
    }
}

WayMap::Start WayMap::start(const Eigen::Vector2d& position) const {
  const std::size_t n = nodes_.size();
  Start start{position, std::vector<double>(n, kInfinity), std::vector<int>(n, -1), {}};
  for (std::size_t a = 0; a < n; ++a) {
    if (walls_.between(position, nodes_[a])) continue;
    const double there = (nodes_[a] - position).norm();
    for (std::size_t b = 0; b < n; ++b)
      if (there + distance_[a * n + b] < start.distance[b]) {
        start.distance[b] = there + distance_[a * n + b];
        start.first[b] = static_cast<int>(a);
      }
  }
  for (std::size_t b = 0; b < n; ++b)
    if (start.first[b] >= 0) start.order.push_back(static_cast<int>(b));
  std::stable_sort(start.order.begin(), start.order.end(),
                   [&](int a, int b) { return start.distance[a] < start.distance[b]; });
  return start;
}

WayMap::Arrival WayMap::arrive(const Start& from, const Eigen::Vector2d& to) const {
  if (walls_.none() || !walls_.between(from.position, to)) return {(to - from.position).norm(), -1};
  Arrival best{kInfinity, -1};
  for (const int node : from.order) {
    const double length = from.distance[node] + (to - nodes_[node]).norm();
    if (from.distance[node] >= best.length) break;
    if (length < best.length && !walls_.between(nodes_[node], to)) best = {length, node};
  }
  return best;
}

double WayMap::length(const Start& from, const Eigen::Vector2d& to) const {
  return arrive(from, to).length;
}

Way WayMap::way(const Start& from, const Eigen::Vector2d& to) const {
  const Arrival arrival = arrive(from, to);
  Way way{{from.position}, arrival.length};
  if (arrival.length == kInfinity) return way;
  if (arrival.node >= 0) {
    int node = from.first[arrival.node];
    way.points.push_back(nodes_[node]);
    while (node != arrival.node) {
      node = next_[node * nodes_.size() + arrival.node];
      way.points.push_back(nodes_[node]);
    }
  }
  way.points.push_back(to);
  return way;
}

}  // namespace anchord
