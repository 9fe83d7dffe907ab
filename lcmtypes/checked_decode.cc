#include "lcmtypes/checked_decode.h"

#include <anchord/frame_t.hpp>
#include <anchord/query_t.hpp>
#include <utility>

#include "lcmtypes/conversion.h"
#include "lcmtypes/field.h"
#include "lcmtypes/wire_check.h"

namespace anchord {

Result<FrameMessage> decode_frame(std::span<const std::uint8_t> bytes) {
  const auto message = decode_checked<frame_t>(check_frame(bytes), bytes);
  if (!message) return message.error();
  const Status unique = check_repeats(*message, Field());
  if (!unique) return unique.error();
  return FrameMessage{from_lcm(*message), message->seq};
}

Result<Query> decode_query(std::span<const std::uint8_t> bytes) {
  auto message = decode_checked<query_t>(check_query(bytes), bytes);
  if (!message) return message.error();
  return Query{message->id, std::move(message->target)};
}

}  // namespace anchord
