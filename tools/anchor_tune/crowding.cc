#include "tools/anchor_tune/crowding.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace anchord::tuning {
namespace {

using Cell = std::array<long, 3>;

Cell cell_of(const Eigen::Vector3d& p, double edge) {
  return {std::lround(p.x() / edge), std::lround(p.y() / edge), std::lround(p.z() / edge)};
}

struct Placed {
  std::size_t frame;
  Eigen::Vector3d position;
};

}  // namespace

double crowding(const Judgement& judgement, int sensor, double radius, int dims) {
  std::map<Cell, std::vector<Placed>> wrong;
  std::vector<Placed> right;
  double frames = 0, volume = 0, wrong_count = 0;
  for (std::size_t f = 0; f < judgement.frames.size(); ++f) {
    if (judgement.frames[f].sensor != sensor) continue;
    ++frames;
    volume += judgement.frames[f].volume;
    for (const Judged& z : judgement.frames[f].detections) {
      if (z.verdict == Verdict::kRight) right.push_back({f, z.in_sensor});
      if (z.verdict != Verdict::kFalse) continue;
      wrong[cell_of(z.in_sensor, radius)].push_back({f, z.in_sensor});
      ++wrong_count;
    }
  }
  double pairs = 0;
  for (const Placed& z : right) {
    const Cell at = cell_of(z.position, radius);
    for (long x = -1; x <= 1; ++x)
      for (long y = -1; y <= 1; ++y)
        for (long h = -1; h <= 1; ++h) {
          const auto near = wrong.find({at[0] + x, at[1] + y, at[2] + h});
          if (near == wrong.end()) continue;
          for (const Placed& other : near->second)
            pairs += other.frame != z.frame && (other.position - z.position).norm() <= radius;
        }
  }
  const double ball = dims == 2 ? std::numbers::pi * radius * radius
                                : 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  // Each right one meets the false ones of all frames but its own.
  const double even = static_cast<double>(right.size()) * wrong_count * (frames - 1) / frames *
                      ball / (volume / frames);
  if (pairs < kLeastPairs || !(even > 0)) return 1;
  return pairs < kEven * even ? 1 : pairs / even;
}

}  // namespace anchord::tuning
