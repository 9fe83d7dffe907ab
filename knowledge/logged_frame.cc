#include "knowledge/logged_frame.h"

#include <boost/crc.hpp>

namespace anchord {

std::uint32_t checksum(const LoggedFrame& frame) {
  boost::crc_32_type crc;
  const auto add_number = [&](std::int64_t number) {
    for (int byte = 0; byte < 8; ++byte)
      crc.process_byte(static_cast<unsigned char>(static_cast<std::uint64_t>(number) >> 8 * byte));
  };
  const auto add_bytes = [&](const void* data, std::size_t size) {
    add_number(static_cast<std::int64_t>(size));
    crc.process_bytes(data, size);
  };
  add_number(static_cast<std::int64_t>(frame.kind));
  add_number(frame.sequence);
  add_number(frame.utime);
  add_number(frame.work ? 1 : 0);
  add_number(frame.work.value_or(0));
  add_bytes(frame.robot.data(), frame.robot.size());
  add_bytes(frame.sensor.data(), frame.sensor.size());
  add_bytes(frame.bytes.data(), frame.bytes.size());
  return crc.checksum();
}

}  // namespace anchord
