#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "api/lcm_log.h"
#include "fuzz/require.h"
#include "lcmtypes/codec.h"

/// The frames that can be read from a log, written to another, can be read from that.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream log(std::string(reinterpret_cast<const char*>(data), size));
  anchord::LcmLogReader reader(log);
  std::ostringstream copy;
  anchord::LcmLogWriter writer(copy);
  std::vector<std::vector<std::uint8_t>> frames;
  while (true) {
    const std::int64_t events = reader.events();
    const auto next = reader.next_frame();
    if (next && !*next) break;                      // the end
    if (!next && reader.events() == events) break;  // damaged for good
    if (!next) continue;                            // a refused frame
    frames.push_back(anchord::canonical_bytes((*next)->frame));
    require(writer.write_frame((*next)->frame).ok());
  }
  std::istringstream written(copy.str());
  anchord::LcmLogReader again(written);
  for (const auto& bytes : frames) {
    const auto next = again.next_frame();
    require(next && *next && anchord::canonical_bytes((*next)->frame) == bytes);
  }
  const auto end = again.next_frame();
  require(end && !*end);
  return 0;
}
