#include "daemon/pace.h"

#include <algorithm>

namespace anchord {
namespace {

constexpr double kNew = 0.1;  // weight of the newest frame

}  // namespace

std::optional<std::uint64_t> Pace::work() const {
  if (seconds_ <= 0) return std::nullopt;
  return static_cast<std::uint64_t>(std::max(1.0, seconds_ * rate_));
}

void Pace::took(std::uint64_t work, double seconds) {
  if (work == 0 || seconds <= 0) return;
  const double rate = static_cast<double>(work) / seconds;
  // Of a short frame much is spent on what is not counted: it does not say that the machine is
  // slow.
  if (rate < rate_ && seconds < seconds_ / 2) return;
  // The mean of times, not of rates: a frame that took long must count as much as it took.
  rate_ = 1 / ((1 - kNew) / rate_ + kNew / rate);
}

}  // namespace anchord
