#pragma once

#include <chrono>
#include <cstddef>

namespace anchord {

/// How much waits to be applied, and whether that is too much: what does not find room is refused,
/// the newest first, and nothing that has been let in is given up. One thread at a time.
class Intake {
 public:
  using Clock = std::chrono::steady_clock;
  /// Frames that may wait, and bytes in which they came: a few of the largest, which take several
  /// times as much in memory.
  static constexpr std::size_t kFrames = 4096, kBytes = std::size_t{64} << 20;

  /// False, and overloaded from then on, if there is no room.
  bool enter(std::size_t frames, std::size_t bytes, Clock::time_point now);
  /// What entered is taken up. Overload ends when no more than half is in use.
  void leave(std::size_t frames, std::size_t bytes, Clock::time_point now);

  struct State {
    std::size_t frames = 0, bytes = 0;
    bool overloaded = false;
    double overloaded_s = 0;  ///< for how long; 0 unless overloaded
  };
  State state(Clock::time_point now) const;

 private:
  std::size_t frames_ = 0, bytes_ = 0, refused_ = 0;
  bool overloaded_ = false;
  Clock::time_point since_;
};

}  // namespace anchord
