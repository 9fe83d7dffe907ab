#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "api/answers.h"
#include "core/verification.h"

namespace anchord {

/// What the stream shows of one instant beside the belief.
struct SceneParts {
  std::vector<Task> tasks;  ///< that have not ended
  std::vector<RobotPose> robots;
};

/// The best world as the stream tells it, rounded to what can be seen, so that little changes from
/// one frame to the next: `utime`, `expected_count`, `hypotheses`, `clusters`, and by their names
/// `objects`, `tasks` and `robots`. Of an object: `class`, `p` (to 0.001), `attributes` (the
/// likeliest symbol, or a scalar's mean), `position` (mm) and `covariance` (two digits; the upper
/// triangle, row by row) of its likeliest tracked model, or, where it is `somewhere` (a weight of
/// 0.5 or more, told to 0.01), of all of its density; `place`, `seen` (the second, since 1970),
/// `extent`, `yaw`, `alias`, `held_by`. What there is not is left out: nothing is null.
nlohmann::json scene_json(const Snapshot& snapshot, const SceneParts& parts);

}  // namespace anchord
