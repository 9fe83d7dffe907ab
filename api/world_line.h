#pragma once

#include <optional>

#include "api/belief_json.h"

namespace anchord {

/// What a line of WORLD.jsonl holds beside the best world.
struct WorldLineOptions {
  bool all = false;                  ///< every anchor of p >= 0.001, with `in_best` and `marginal`
  int hypotheses = 0;                ///< that many of the best hypotheses of each cluster
  std::optional<double> elapsed_us;  ///< how long the frame took
};

/// The belief after a frame: the best world, how many objects are expected, how many hypotheses
/// and clusters there are. Objects stand in order of birth.
Json world_line(const Belief& belief, const Background& background,
                const WorldLineOptions& options = {});

}  // namespace anchord
