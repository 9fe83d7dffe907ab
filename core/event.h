#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/time.h"

namespace anchord {

/// A part of space in which an object is looked for, map frame, metres. In a 2-D world heights are
/// not looked at.
struct RegionOfInterest {
  enum class Kind { kEllipsoid = 0, kPrism = 1 };
  Kind kind = Kind::kEllipsoid;
  double p = 1;  ///< the mass of the object's predicted density that it holds, given it exists
  std::array<double, 3> center{};              ///< ellipsoid
  std::array<double, 9> covariance{};          ///< ellipsoid, row-major
  double radius = 0;                           ///< ellipsoid: Mahalanobis distance of its surface
  std::vector<std::array<double, 2>> polygon;  ///< prism
  std::array<double, 2> z{};                   ///< prism: least and most height
  bool operator==(const RegionOfInterest&) const = default;
};

/// Something that was done to an object, or said of it, rather than seen: by the robot's own work,
/// by a person, or by a verification that did not find it. It enters the belief in its place in
/// time and stands in the log as a frame does.
struct Event {
  enum class Kind {
    kMissing = 0,  ///< looked for in `regions` by `sensor` and not found
    kGrasped = 1,  ///< `robot` holds it: it moves with the robot
    kCarried = 2,  ///< where the robot that holds it is now: `position`, `covariance`
    kPlaced = 3,   ///< put down: at `position`, or somewhere in `place`, or where the robot is
    kMoved = 4,    ///< somebody moved it: to `position`, somewhere in `place`, or nobody knows
    kRemoved = 5,  ///< it has left the world
    kNamed = 6,    ///< `other` is what people call it; empty: no longer
    kJoined = 7,   ///< `object` and `other` are one
    kDropped = 8,  ///< there never was such an object
    kUndone = 9    ///< takes back the event with the number `undone` (kNamed, kJoined, kDropped)
  };
  Kind kind = Kind::kMissing;
  Utime utime = 0;
  std::string robot;   ///< who did it, or empty for the only one
  std::string object;  ///< id (or alias) of the anchor it is about; empty for kUndone, kCarried
  std::string other;   ///< kNamed: the alias; kJoined: the other anchor
  std::string place;   ///< kPlaced, kMoved: a place's name, or empty
  std::string sensor;  ///< kMissing
  std::optional<std::array<double, 3>> position;    ///< map frame, m
  std::optional<std::array<double, 9>> covariance;  ///< of `position`, row-major, m^2
  std::vector<RegionOfInterest> regions;            ///< kMissing
  std::int64_t undone = 0;                          ///< kUndone
  bool operator==(const Event&) const = default;
};

/// Most regions that one event or task may name, and most points of a prism.
inline constexpr std::size_t kMaxRegions = 256;

}  // namespace anchord
