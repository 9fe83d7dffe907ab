#include "api/sighting.h"

#include <limits>

#include "anchoring/map_frame.h"

namespace anchord {

Json sighting_json(const ObjectBelief& object, const FramesAt& frames_at,
                   const Background& background) {
  const Leaf& leaf = object.shown();
  if (leaf.last_seen == 0) return nullptr;
  Json out{{"utime", leaf.last_seen}};
  // The detection's index is in what the leaf remembers, unless limits make it forget.
  const bool remembers = !leaf.recent.empty();
  const std::size_t remembered = remembers ? leaf.recent.back() & 0xffff : 0;
  const Eigen::Vector3d where = moments(leaf).mean;
  double nearest = std::numeric_limits<double>::infinity();
  for (const NumberedFrame& one : frames_at(leaf.last_seen)) {
    const auto placed = place_in_map(one.frame, background);
    if (!placed) continue;
    for (std::size_t z = 0; z < placed->detections.size(); ++z) {
      if (remembers && z != remembered) continue;
      const Eigen::Vector3d& seen = placed->detections[z].position.mean;
      const double distance = (seen - where).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      out["robot"] = one.frame.robot;
      out["sensor"] = one.frame.sensor;
      out["frame"] = one.number;
      out["detection"] = z;
      out["position"] = position_json(seen, background.dims);
    }
  }
  return out;
}

}  // namespace anchord
