#include "anchoring/concern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace anchord {

Concern::Concern(const MapFrame& frame, const Background& background)
    : utime_(frame.utime), everything_(false) {
  if (!frame.view.sees_nothing())
    windows_.push_back(
        Window::of(frame.utime, frame.view.bounds(), background.sight_deviations, 0, background));
  if (frame.detections.empty()) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 4> box{kInfinity, kInfinity, -kInfinity, -kInfinity};
  double widest = 0;
  for (const MapDetection& z : frame.detections) {
    const auto& [mean, covariance] = z.position;
    box = {std::min(box[0], mean.x()), std::min(box[1], mean.y()), std::max(box[2], mean.x()),
           std::max(box[3], mean.y())};
    widest = std::max({widest, covariance(0, 0), covariance(1, 1)});
    if (!z.object.empty()) named_.push_back(z.object);
  }
  everything_ = std::isinf(background.gate_distance2);
  if (!everything_)
    windows_.push_back(
        Window::of(frame.utime, box, std::sqrt(background.gate_distance2), widest, background));
}

bool Concern::with(const Reach& reach) const {
  if (everything_ || reach.due <= utime_) return true;
  return std::any_of(windows_.begin(), windows_.end(),
                     [&](const Window& window) { return reach.meets(window); });
}

bool Concern::names(const Cluster& cluster) const {
  const auto called = [&](const AnchorTree& tree) {
    return std::any_of(named_.begin(), named_.end(),
                       [&](const std::string& name) { return tree.anchor->is_called(name); });
  };
  return std::any_of(cluster.anchors.begin(), cluster.anchors.end(), called);
}

}  // namespace anchord
