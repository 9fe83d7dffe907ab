#pragma once

#include <optional>
#include <vector>

#include "maintenance/gain.h"

namespace anchord {

/// A place to look from: what a robot may drive to.
struct Viewpoint {
  int subject = 0;  ///< that it is for
  int eye = 0;
  BasePose base;
  bool shared = false;  ///< stands where several are seen
};

/// Where to stand so that the eye sees the point: at the middle of its useful range, on the side
/// of `from`, the sensor towards it; other bearings and ranges where walls, the world's bounds or
/// heights are against that. None if nowhere. An eye that does not move the base: where it is,
/// if it sees the point from there.
std::optional<BasePose> viewpoint_of(const Eigen::Vector3d& point_map, const Eye& eye,
                                     const BasePose& from, const Site& site);

/// For each target and eye one viewpoint, and for each eye up to `shared` more that see several
/// subjects: a greedy cover (Nemhauser, Wolsey, Fisher 1978) of the subjects, each weighted with
/// its possible gain, by candidates between neighbours. In order: subject, eye; then the shared
/// ones. Of more than `targets` targets only those of the greatest entropy have any.
std::vector<Viewpoint> viewpoints(const std::vector<Subject>& subjects, const BasePose& from,
                                  int shared, int targets, const Site& site);

/// The looks along a way to a viewpoint: every `step` seconds on it, heading along it, and from the
/// arrival on for the eye's dwell time, heading as the viewpoint says. The first is at `start` (s)
/// plus one step; turning takes no time. `end` is when it is over.
struct Course {
  std::vector<Glance> looks;
  double length = 0;  ///< m
  double end = 0;     ///< s
};
void follow(const Way& way, const Viewpoint& viewpoint, double start, const Site& site,
            Course& course);

}  // namespace anchord
