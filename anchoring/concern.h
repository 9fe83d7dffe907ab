#pragma once

#include <string>
#include <vector>

#include "anchoring/belief.h"
#include "anchoring/map_frame.h"
#include "core/scratch.h"

namespace anchord {

/// Which clusters a frame may concern: those that may be in view, that may be given a detection, or
/// that time may have changed. All others it leaves as they are.
class Concern {
 public:
  Concern(const MapFrame& frame, const Background& background);

  bool operator()(const Reach& reach) const { return !named_.empty() || with(reach); }
  bool operator()(const Clusters::Entry& entry) const {
    return with(entry.reach) || names(*entry.cluster);
  }

 private:
  bool with(const Reach& reach) const;
  /// Whether a detection names one of its anchors.
  bool names(const Cluster& cluster) const;

  Utime utime_;
  bool everything_;                        ///< no gate
  SmallScratchVector<Window, 2> windows_;  ///< of the view, and of the detections
  std::vector<std::string> named_;
};

}  // namespace anchord
