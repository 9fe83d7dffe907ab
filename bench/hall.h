#pragma once

#include <vector>

#include "core/frame.h"
#include "knowledge/knowledge.h"

namespace anchord::bench {

/// A hall of 20 x 10 m; `cell` (m): of the grid of what has not been detected.
Knowledge hall(double cell);

/// What is seen in it: each frame sees one half, in turn, with its ten objects 2 m apart.
std::vector<Frame> hall_frames(int count, double frames_per_second);

}  // namespace anchord::bench
