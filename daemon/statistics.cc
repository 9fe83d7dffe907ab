#include "daemon/statistics.h"

#include <algorithm>
#include <utility>

namespace anchord {

void UpdateTimes::add(double seconds) {
  std::lock_guard lock(mutex_);
  latest_[count_++ % latest_.size()] = seconds;
  sum_ += seconds;
}

UpdateTimes::Summary UpdateTimes::summary() const {
  std::vector<double> sorted;
  Summary out;
  {
    std::lock_guard lock(mutex_);
    out.count = count_;
    out.sum_s = sum_;
    sorted.assign(latest_.begin(), latest_.begin() + static_cast<long>(std::min<std::uint64_t>(
                                                         count_, latest_.size())));
  }
  if (sorted.empty()) return out;
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double q) {
    return 1e6 * sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  };
  out.median_us = quantile(0.5);
  out.p99_us = quantile(0.99);
  out.max_us = quantile(1);
  return out;
}

std::uint64_t SequenceGaps::missing(const std::string& robot, const std::string& sensor,
                                    std::int64_t seq) {
  if (seq <= 0) return 0;
  if (last_.size() >= kSensors) last_.clear();
  // A sensor that has not been heard before is not known to have begun at 1.
  const auto [it, first] = last_.try_emplace({robot, sensor}, seq);
  const std::int64_t before = std::exchange(it->second, seq);
  return first || seq <= before ? 0 : static_cast<std::uint64_t>(seq - before - 1);
}

}  // namespace anchord
