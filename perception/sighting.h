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
    kAbsent,    ///< all of the region was in sight, and the object was not there
    kHidden,    ///< too little of the region was in sight to say so
    kDoubtful,  ///< something may be it: nothing is said (thesis section 3.7.3: in case of doubt a
                ///< detection is not published)
  };
  Sight sight = Sight::kDoubtful;
  std::optional<Detection> detection;  ///< kFound: in the map frame; names the object
  cv::Rect box;                        ///< the pixels that were read, of the picture
  double looked_at = 0;                ///< their share of the picture
  double visible = 0;  ///< share of the predicted density that was in sight; 1 where found
  std::string reason;  ///< in words
};

}  // namespace anchord
