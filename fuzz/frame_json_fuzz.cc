#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "api/frame_json.h"
#include "fuzz/require.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"

/// What parse_frames() accepts comes back the same through JSON, and the same bytes through LCM;
/// what it refuses it refuses in words that fit into JSON.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto frames = anchord::parse_frames({reinterpret_cast<const char*>(data), size});
  if (!frames) {
    (void)nlohmann::json(frames.error().text()).dump();  // throws if it is no UTF-8
    return 0;
  }
  for (const anchord::Frame& frame : *frames) {
    const auto read = anchord::parse_frame(anchord::to_json(frame).dump());
    require(read.ok() && *read == frame);
    const auto bytes = anchord::canonical_bytes(frame);
    const auto decoded = anchord::decode_frame(bytes);
    require(decoded.ok() && anchord::canonical_bytes(decoded->frame) == bytes);
  }
  return 0;
}
