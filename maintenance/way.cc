#include "maintenance/way.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anchord {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

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
