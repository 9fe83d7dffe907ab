#include <algorithm>
#include <vector>

#include "tests/anchoring/dice.h"
#include "tests/anchoring/random_scene.h"

namespace anchord::enumeration {
namespace {

double choose(std::size_t n, std::size_t k) {
  double result = 1;
  for (std::size_t i = 0; i < k; ++i)
    result *= static_cast<double>(n - i) / static_cast<double>(i + 1);
  return result;
}

}  // namespace

Variety random_variety(std::mt19937_64& random) {
  Dice dice(random);
  Variety v;
  for (bool* kind : {&v.three_d, &v.classes, &v.attributes, &v.scores, &v.several_models,
                     &v.undetectable, &v.somewhere, &v.views, &v.correlated, &v.departures,
                     &v.arrivals, &v.outside, &v.sensors, &v.late, &v.verification, &v.changes})
    *kind = dice.chance(0.4);
  std::mt19937_64 apart = random;  // so that scenes without them stay as they are
  Dice more(apart);
  for (bool* kind : {&v.shared, &v.doubled, &v.phantoms, &v.looks, &v.ranged})
    *kind = more.chance(0.4);
  v.changes = v.changes && v.attributes;
  v.phantoms = v.phantoms && v.classes;
  v.looks = v.looks && v.classes;
  v.late = v.late && !v.verification;  // a detection cannot name what has not arrived yet
  return v;
}

double count_worlds(const std::vector<std::size_t>& detections, bool departures) {
  std::vector<double> worlds{1};  // [n]: worlds in which n objects exist
  for (const std::size_t n : detections) {
    std::vector<double> next(worlds.size() + n, 0);
    for (std::size_t before = 0; before < worlds.size(); ++before) {
      for (std::size_t stay = departures ? 0 : before; stay <= before; ++stay) {
        for (std::size_t seen = 0; seen <= std::min(stay, n); ++seen) {
          double orders = 1;  // of those seen again over the detections that they gave
          for (std::size_t i = 1; i <= seen; ++i) orders *= static_cast<double>(i);
          for (std::size_t fresh = 0; fresh + seen <= n; ++fresh)
            next[stay + fresh] += worlds[before] * choose(before, stay) * choose(stay, seen) *
                                  choose(n, seen) * orders * choose(n - seen, fresh);
        }
      }
    }
    worlds = next;
  }
  double sum = 0;
  for (const double w : worlds) sum += w;
  return sum;
}

}  // namespace anchord::enumeration
