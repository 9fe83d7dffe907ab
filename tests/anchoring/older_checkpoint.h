#pragma once

#include <vector>

#include "anchoring/world.h"

namespace anchord {

/// The scene that checkpoints in tests/data were written of, after all of `before`.
struct OlderScene {
  Knowledge knowledge;
  std::vector<Accepted> before, after;
};

/// Classes with several models, places, arrivals on the move, phantoms with scores; objects that
/// were seen in part, named, joined, dropped, grasped and looked for in vain. Never to be changed:
/// the bytes are of this.
OlderScene older_scene();

/// Takes what must be accepted.
void take(World& world, const Accepted& step);

}  // namespace anchord
