#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "core/frame.h"

namespace anchord {

/// What one look at one picture told about the object of a verification task.
struct Sighting {
  enum class Sight {
    kFound,
    kAbsent,     ///< all of the region was in sight, and the object was not there
    kHidden,     ///< too little of the region was in sight to say so
    kElsewhere,  ///< a carried camera does not look there, or not yet from where the task says
    kDoubtful,   ///< something may be it: nothing is said (thesis section 3.7.3: in case of doubt a
                 ///< detection is not published)
  };
  Sight sight = Sight::kDoubtful;
  /// kFound; names the object. In the frame of the picture's pose (see in_sensor_frame()), without
  /// one in the map frame.
  std::optional<Detection> detection;
  cv::Rect box;          ///< the pixels that were read, of the picture
  double looked_at = 0;  ///< their share of the picture
  double visible = 0;    ///< share of the predicted density that was in sight; 1 where found
  std::string reason;    ///< in words
};

}  // namespace anchord
