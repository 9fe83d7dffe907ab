#pragma once

#include "tests/anchoring/dice.h"
#include "tests/anchoring/random_scene.h"

namespace anchord::enumeration {

/// Lets some p_D of a scene depend on the distance, and most of its frames say where the sensor is:
/// whole cells away, and not turned, so that views still end along cell borders.
void add_ranges(Scene& scene, Dice& dice);

}  // namespace anchord::enumeration
