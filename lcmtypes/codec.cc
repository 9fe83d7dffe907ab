#include "lcmtypes/codec.h"

#include "lcmtypes/conversion.h"

namespace anchord {

std::vector<std::uint8_t> encode(const Frame& frame, std::int64_t seq) {
  return encode_message(to_lcm(frame, seq));
}

std::vector<std::uint8_t> canonical_bytes(const Frame& frame) { return encode(frame, 0); }

}  // namespace anchord
