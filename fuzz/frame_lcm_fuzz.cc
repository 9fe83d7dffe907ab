#include <cstddef>
#include <cstdint>

#include "fuzz/require.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"

/// What decode_frame() accepts encodes to bytes that decode to the same frame.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto message = anchord::decode_frame({data, size});
  if (!message) return 0;
  const auto bytes = anchord::encode(message->frame, message->seq);
  const auto again = anchord::decode_frame(bytes);
  require(again.ok());
  // Bytes, not frames: a NaN does not equal itself.
  require(anchord::encode(again->frame, again->seq) == bytes);
  return 0;
}
