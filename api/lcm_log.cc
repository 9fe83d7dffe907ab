#include "api/lcm_log.h"

#include <algorithm>
#include <array>
#include <istream>
#include <ostream>
#include <utility>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/names.h"

namespace anchord {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;
constexpr std::uint32_t kMaxChannelBytes = 1000;  // as liblcm's reader
constexpr std::uint32_t kMaxDataBytes = 0x7fffffff;

using Header = std::array<char, kHeaderBytes>;

std::uint32_t read_u32(const Header& header, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<std::uint8_t>(header[at + i]);
  return value;
}

std::string event_field(std::int64_t index) { return "event[" + std::to_string(index) + "]"; }

void append_big_endian(std::string& to, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) to += static_cast<char>(value >> (8 * i));
}

}  // namespace

Error LcmLogReader::damage(const char* message) {
  damage_ = invalid(event_field(events_), message);
  return *damage_;
}

Result<std::optional<LcmLogReader::Message>> LcmLogReader::next_of(
    std::initializer_list<std::string_view> channels) {
  while (true) {
    if (damage_) return *damage_;
    Header header;
    stream_.read(header.data(), header.size());
    if (stream_.gcount() == 0) return std::optional<Message>();
    if (!stream_) return damage("the log ends inside the header of an event");
    if (read_u32(header, 0) != kSync) return damage("no event of an LCM log starts here");
    const std::uint32_t channel_bytes = read_u32(header, 20), data_bytes = read_u32(header, 24);
    if (channel_bytes == 0 || channel_bytes > kMaxChannelBytes) {
      return damage("the channel's length must be 1 to 1000");
    }
    if (data_bytes > kMaxDataBytes) return damage("the data's length must not be negative");
    std::string found(channel_bytes, '\0');
    if (!stream_.read(found.data(), channel_bytes)) return damage("the log ends inside an event");
    const bool wanted = std::find(channels.begin(), channels.end(), found) != channels.end();
    const bool too_large = data_bytes > kMaxMessageBytes;
    std::vector<std::uint8_t> data;
    if (wanted && !too_large) {
      data.resize(data_bytes);
      stream_.read(reinterpret_cast<char*>(data.data()), data_bytes);
    } else {
      stream_.ignore(data_bytes);
    }
    if (stream_.gcount() != data_bytes) return damage("the log ends inside an event");
    const std::int64_t index = events_++;
    if (wanted && too_large) return invalid(event_field(index), "the message has more than 8 MiB");
    if (wanted) return std::optional(Message{std::move(found), std::move(data)});
  }
}

Result<std::optional<std::vector<std::uint8_t>>> LcmLogReader::next(const std::string& channel) {
  auto message = next_of({channel});
  if (!message) return message.error();
  if (!*message) return std::optional<std::vector<std::uint8_t>>();
  return std::optional(std::move((**message).data));
}

Error LcmLogReader::at_event(Error error) const {
  const std::string event = event_field(events_ - 1);
  error.field = error.field.empty() ? event : event + "." + error.field;
  return error;
}

Result<std::optional<FrameMessage>> LcmLogReader::next_frame() {
  auto data = next(kDetectionsChannel);
  if (!data) return data.error();
  if (!*data) return std::optional<FrameMessage>();
  Result<FrameMessage> message = decode_frame(**data);
  if (!message) return at_event(message.error());
  return std::optional(std::move(*message));
}

Result<std::optional<std::variant<Frame, Event>>> LcmLogReader::next_input() {
  using Input = std::variant<Frame, Event>;
  for (;;) {
    auto item = next_item();
    if (!item) return item.error();
    if (!*item) return std::optional<Input>();
    if (auto* frame = std::get_if<Frame>(&**item)) return std::optional<Input>(std::move(*frame));
    if (auto* event = std::get_if<Event>(&**item)) return std::optional<Input>(std::move(*event));
  }
}

Result<std::optional<std::variant<Frame, Event, std::string>>> LcmLogReader::next_item() {
  using Item = std::variant<Frame, Event, std::string>;
  auto message = next_of({kDetectionsChannel, kEventChannel, kReplayChannel});
  if (!message) return message.error();
  if (!*message) return std::optional<Item>();
  const auto& [channel, data] = **message;
  if (channel == kReplayChannel) return std::optional<Item>(std::string(data.begin(), data.end()));
  if (channel == kEventChannel) {
    auto event = decode_event(data);
    if (!event) return at_event(event.error());
    return std::optional<Item>(std::move(event->event));
  }
  auto frame = decode_frame(data);
  if (!frame) return at_event(frame.error());
  return std::optional<Item>(std::move(frame->frame));
}

Status LcmLogWriter::write(const std::string& channel, Utime utime,
                           std::span<const std::uint8_t> data) {
  std::string header;
  append_big_endian(header, kSync, 4);
  append_big_endian(header, static_cast<std::uint64_t>(events_++), 8);
  append_big_endian(header, static_cast<std::uint64_t>(utime), 8);
  append_big_endian(header, channel.size(), 4);
  append_big_endian(header, data.size(), 4);
  stream_ << header << channel;
  stream_.write(reinterpret_cast<const char*>(data.data()),
                static_cast<std::streamsize>(data.size()));
  if (!stream_) return Error{ErrorCode::kIo, "", "cannot write the LCM log"};
  return Done{};
}

Status LcmLogWriter::write_frame(const Frame& frame) {
  return write(kDetectionsChannel, frame.utime, encode(frame, ++frames_));
}

Status LcmLogWriter::write_event(const Event& event) {
  return write(kEventChannel, event.utime, encode(event, ++done_));
}

}  // namespace anchord
