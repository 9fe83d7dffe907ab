#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "lcmtypes/channels.h"

namespace anchord {

/// The channels that the daemon hears. A record names one by its index here.
inline constexpr std::array kReceivedChannels = {kDetectionsChannel, kEventChannel, kTriggerChannel,
                                                 kResultChannel,     kPoseChannel,  kQueryChannel};

/// What the process that receives LCM tells the daemon, over a stream socket.
struct LcmRecord {
  enum class Kind : std::uint8_t {
    kJoined,   ///< it has joined the network, and waits to begin
    kFailed,   ///< it cannot, and ends; bytes: why
    kHears,    ///< it passes on what is sent from now on
    kMessage,  ///< bytes: of a message that the daemon's decoder takes
    kRefused,  ///< bytes: of a Refusal
    kDrops,    ///< bytes: of LcmDrops
  };
  Kind kind = Kind::kJoined;
  std::uint8_t channel = 0;  ///< an index of kReceivedChannels; of messages and refusals
  std::span<const std::uint8_t> bytes = {};
};

/// What was lost since the last record of this kind.
struct LcmDrops {
  std::uint64_t waiting = 0;    ///< messages, because too much waited for the daemon
  std::uint64_t by_kernel = 0;  ///< datagrams, because the receive buffer was full
};

/// Puts a record behind those in `to`.
void append(const LcmRecord& record, std::vector<std::uint8_t>& to);

/// The text of an error and back, for kRefused.
std::vector<std::uint8_t> refusal_bytes(const Error& why);
Error refusal(std::span<const std::uint8_t> bytes);

std::array<std::uint8_t, sizeof(LcmDrops)> drops_bytes(const LcmDrops& drops);
LcmDrops drops(std::span<const std::uint8_t> bytes);

/// Takes a stream of bytes apart into records. Whoever writes may have been taken over by what it
/// received, so nothing is believed: at most one record's bytes are kept.
class LcmRecords {
 public:
  /// Adds bytes that were read.
  void add(std::span<const std::uint8_t> bytes);
  /// The next whole record, which is valid until add(); none while there is not one. An error once
  /// the stream cannot be understood any more.
  Result<std::optional<LcmRecord>> next();

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t taken_ = 0;
};

}  // namespace anchord
