#pragma once

#include <cstdint>
#include <optional>

namespace anchord {

/// Turns a time that a frame may take into a bound on counted work (Effort), by how fast this
/// machine has been of late. The bound is chosen before the frame and goes into the log with it;
/// the engine itself reads no clock.
class Pace {
 public:
  /// `seconds` per frame; 0: no bound.
  explicit Pace(double seconds) : seconds_(seconds) {}

  /// The bound for the next frame.
  std::optional<std::uint64_t> work() const;
  /// What a frame took.
  void took(std::uint64_t work, double seconds);

 private:
  double seconds_;
  double rate_ = kFirstRate;  // work per second
  /// A slow machine's; of a fast one it takes some frames to see what it can do.
  static constexpr double kFirstRate = 1e6;
};

}  // namespace anchord
