#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "lcmtypes/codec.h"

/// Encoded messages, changed on purpose, and what a decoder says of them.
namespace anchord::testing {

using Bytes = std::vector<std::uint8_t>;
using Span = std::span<const std::uint8_t>;

/// Writes `value` as LCM does, big-endian, over the 4 bytes from `at`, whatever they are part of.
inline void overwrite(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

/// The field that `decoder` refuses, or "accepted".
template <typename Message>
std::string field_of(Result<Message> (*decoder)(Span), const Bytes& bytes) {
  const Result<Message> message = decoder(bytes);
  return message ? "accepted" : message.error().field;
}

/// field_of() a valid message after a change to it as lcm-gen has it.
template <typename Wire, typename Message>
std::string field_with(Result<Message> (*decoder)(Span), const Bytes& valid,
                       const std::function<void(Wire&)>& change) {
  Wire message;
  EXPECT_GT(message.decode(valid.data(), 0, static_cast<int>(valid.size())), 0);
  change(message);
  return field_of(decoder, encode_message(message));
}

}  // namespace anchord::testing
