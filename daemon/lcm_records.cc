#include "daemon/lcm_records.h"

#include <algorithm>
#include <cstring>

#include "lcmtypes/names.h"

namespace anchord {
namespace {

/// Before the bytes of each record, as it lies in memory: both ends are the same program.
struct Head {
  std::uint32_t size;
  std::uint8_t kind;
  std::uint8_t channel;
  std::uint16_t unused;
};

}  // namespace

void append(const LcmRecord& record, std::vector<std::uint8_t>& to) {
  const Head head{static_cast<std::uint32_t>(record.bytes.size()),
                  static_cast<std::uint8_t>(record.kind), record.channel, 0};
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&head);
  to.insert(to.end(), begin, begin + sizeof head);
  to.insert(to.end(), record.bytes.begin(), record.bytes.end());
}

std::vector<std::uint8_t> refusal_bytes(const Error& why) {
  std::vector<std::uint8_t> bytes(why.field.begin(), why.field.end());
  bytes.push_back(0);
  bytes.insert(bytes.end(), why.message.begin(), why.message.end());
  return bytes;
}

Error refusal(std::span<const std::uint8_t> bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), 0);
  return {ErrorCode::kInvalid, std::string(bytes.begin(), end),
          std::string(end == bytes.end() ? end : end + 1, bytes.end())};
}

std::array<std::uint8_t, sizeof(LcmDrops)> drops_bytes(const LcmDrops& drops) {
  std::array<std::uint8_t, sizeof(LcmDrops)> bytes;
  std::memcpy(bytes.data(), &drops, sizeof drops);
  return bytes;
}

LcmDrops drops(std::span<const std::uint8_t> bytes) {
  LcmDrops out;
  if (bytes.size() == sizeof out) std::memcpy(&out, bytes.data(), sizeof out);
  return out;
}

void LcmRecords::add(std::span<const std::uint8_t> bytes) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(taken_));
  taken_ = 0;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

Result<std::optional<LcmRecord>> LcmRecords::next() {
  const auto rest = std::span<const std::uint8_t>(bytes_).subspan(taken_);
  Head head;
  if (rest.size() < sizeof head) return std::optional<LcmRecord>();
  std::memcpy(&head, rest.data(), sizeof head);
  if (head.size > kMaxMessageBytes || head.channel >= kReceivedChannels.size() ||
      head.kind > static_cast<std::uint8_t>(LcmRecord::Kind::kDrops))
    return Error{ErrorCode::kInvalid, "lcm", "the process that receives LCM tells nonsense"};
  if (rest.size() < sizeof head + head.size) return std::optional<LcmRecord>();
  taken_ += sizeof head + head.size;
  return std::optional(LcmRecord{static_cast<LcmRecord::Kind>(head.kind), head.channel,
                                 rest.subspan(sizeof head, head.size)});
}

}  // namespace anchord
