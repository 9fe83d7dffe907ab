#include "tools/anchor_tune/doubles.h"

#include <cmath>

#include "anchoring/shared_detection.h"
#include "tools/anchor_tune/optimum.h"

namespace anchord::tuning {

std::optional<Doubles> fit_doubles(const Judgement& judgement, int sensor, double density,
                                   int dims) {
  Doubles result;
  std::vector<double> near;  // densities of a repeat over that of others
  Sensor once;
  once.double_detection = 1;
  for (const JudgedFrame& frame : judgement.frames) {
    if (frame.sensor != sensor) continue;
    result.detections += static_cast<std::int64_t>(frame.detections.size());
    for (std::size_t i = 0; i < frame.detections.size(); ++i) {
      const bool right = frame.detections[i].verdict == Verdict::kRight;
      MapFrame others;  // that one of both is right does not say which of them is the repeat
      others.sensor = &once;
      int z = -1;
      for (std::size_t j = 0; j < frame.detections.size(); ++j) {
        if (i == j) z = static_cast<int>(others.detections.size());
        if (i == j || !right || frame.detections[j].verdict == Verdict::kFalse)
          others.detections.push_back(frame.detections[j].placed);
      }
      if (frame.detections[i].verdict != Verdict::kNeutral)
        near.push_back(repeat_density(others, z, dims) / density);
    }
  }
  const auto f = [&](const std::vector<double>& x) {
    const double often = from_free(x[0], Scale::kLogit);
    double sum = -often * static_cast<double>(result.detections);
    for (const double ratio : near) sum += std::log1p(often * ratio);
    return sum;
  };
  const Optimum best = maximise(f, {to_free(0.01, Scale::kLogit)}, 1, 200);
  if (!(best.value > 0.5 * std::log(static_cast<double>(result.detections)))) return std::nullopt;
  result.often = profile_interval(f, best, 0, Scale::kLogit);
  for (const double ratio : near)
    result.repeats += result.often.value * ratio / (1 + result.often.value * ratio);
  return result;
}

}  // namespace anchord::tuning
