#pragma once

#include <array>
#include <cstdint>

#include "anchoring/background.h"
#include "core/time.h"

namespace anchord {

struct Cluster;

/// A part of the plane at one time, in which densities are looked for.
struct Window {
  Utime utime = 0;
  std::array<double, 4> box{};  ///< x_min, y_min, x_max, y_max
  double deviations = 0;        ///< how far from its mean, along each axis, a density counts
  double variance = 0;          ///< m^2, added to that of a density along each axis
  std::uint64_t places = 0;     ///< that have a part in it, see Background::places_in()

  static Window of(Utime utime, const std::array<double, 4>& box, double deviations,
                   double variance, const Background& background);
};

/// Where the densities of some leaves may be from now on, and by when they must be looked at in any
/// case. Conservative: what it rules out is so, for as long as nothing but time changes the leaves.
struct Reach {
  struct Axis {
    double low, high;                  ///< of the means at `from`, m
    double slowest = 0, fastest = 0;   ///< of their velocities and of rest, m/s
    std::array<double, 4> variance{};  ///< bounded by the polynomial in time since `from`, m^2
    bool meets(double min, double max, double dt, double deviations, double more_variance) const;
  };

  Reach();
  static Reach of(const Cluster& cluster, const Background& background);
  void include(const Reach& other);

  /// Whether a density may count in the window, whose time is not before `from`.
  bool meets(const Window& window) const;

  Utime from;                ///< of the oldest leaf
  std::array<Axis, 2> axis;  ///< x and y of the tracked behaviour models
  std::uint64_t places = 0;  ///< where it may be `somewhere`, see Background::places_in()
  /// From then on time alone may have made it another: its class's models, or nothing at all.
  Utime due;
};

}  // namespace anchord
