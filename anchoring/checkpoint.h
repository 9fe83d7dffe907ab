#pragma once

#include <cstdint>
#include <vector>

#include "anchoring/world.h"

namespace anchord {

/// The state as bytes, for this machine's byte order: what is shared in the belief stands there
/// once. A state of the same history gives the same bytes.
std::vector<std::uint8_t> write_checkpoint(const WorldState& state, const Background& background);

/// The state that was written, to the bit, for a world of the same knowledge; also by an older
/// program. kInvalid: the bytes end too early, are of a newer program, or for other knowledge. They
/// are trusted beyond that: keep a checksum beside them.
Result<WorldState> read_checkpoint(const std::vector<std::uint8_t>& bytes, const World& empty);

}  // namespace anchord
