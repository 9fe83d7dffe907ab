#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/require.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/image_codec.h"
#include "lcmtypes/verification_codec.h"

namespace {

std::vector<std::uint8_t> encode(const anchord::EventMessage& message) {
  return anchord::encode(message.event, message.seq);
}

/// What `decoder` accepts encodes to bytes that decode to the same message.
template <typename Message>
void try_decoder(anchord::Result<Message> (*decoder)(std::span<const std::uint8_t>),
                 std::span<const std::uint8_t> data) {
  const auto message = decoder(data);
  if (!message) return;
  const auto bytes = encode(*message);
  const auto again = decoder(bytes);
  require(again.ok());
  // Bytes, not messages: a NaN does not equal itself.
  require(encode(*again) == bytes);
}

}  // namespace

/// The message's fingerprint says whose it is: the other decoders refuse it at once.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  try_decoder(anchord::decode_event, bytes);
  try_decoder(anchord::decode_trigger, bytes);
  try_decoder(anchord::decode_task, bytes);
  try_decoder(anchord::decode_result, bytes);
  try_decoder(anchord::decode_pose, bytes);
  try_decoder(anchord::decode_image, bytes);
  return 0;
}
