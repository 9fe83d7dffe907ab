#pragma once

#include <cstdint>
#include <vector>

#include "anchoring/reading.h"

namespace anchord {

/// The best world as an encoded world_t, for ANCHORD_WORLD; `seq` counts the messages.
std::vector<std::uint8_t> encode_world(const Belief& belief, const Background& background,
                                       std::int64_t seq);

}  // namespace anchord
