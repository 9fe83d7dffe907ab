#pragma once

#include "knowledge/knowledge.h"
#include "tests/anchoring/dice.h"

namespace anchord::enumeration {

/// Lets what is false look like one of the classes: phantoms, and clutter of some sensors; shares
/// of what is right differ by label.
void add_looks(Knowledge& knowledge, Dice& dice);

}  // namespace anchord::enumeration
