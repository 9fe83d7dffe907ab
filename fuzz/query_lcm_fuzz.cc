#include <anchord/query_t.hpp>
#include <cstddef>
#include <cstdint>

#include "fuzz/require.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"

/// What decode_query() accepts encodes to the very bytes it came from.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto query = anchord::decode_query({data, size});
  if (!query) return 0;
  anchord::query_t message{};
  message.id = query->id;
  message.target = query->target;
  require(anchord::encode_message(message) == std::vector<std::uint8_t>(data, data + size));
  return 0;
}
