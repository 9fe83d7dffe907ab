#include "daemon/intake.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace anchord {
namespace {

double seconds(Intake::Clock::duration time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

bool Intake::enter(std::size_t frames, std::size_t bytes, Clock::time_point now) {
  if (frames_ + frames > kFrames || bytes_ + bytes > kBytes) {
    refused_ += frames;
    if (std::exchange(overloaded_, true)) return false;
    since_ = now;
    spdlog::warn("overloaded: {} frames wait to be applied, more are refused", frames_);
    return false;
  }
  frames_ += frames;
  bytes_ += bytes;
  return true;
}

void Intake::leave(std::size_t frames, std::size_t bytes, Clock::time_point now) {
  frames_ -= frames;
  bytes_ -= bytes;
  if (!overloaded_ || frames_ > kFrames / 2 || bytes_ > kBytes / 2) return;
  overloaded_ = false;
  spdlog::warn("no longer overloaded, after {:.1f} s in which {} frames were refused",
               seconds(now - since_), std::exchange(refused_, 0));
}

Intake::State Intake::state(Clock::time_point now) const {
  return {frames_, bytes_, overloaded_, overloaded_ ? seconds(now - since_) : 0};
}

}  // namespace anchord
