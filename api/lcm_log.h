#pragma once

#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/event.h"
#include "core/frame.h"
#include "core/result.h"
#include "core/time.h"
#include "lcmtypes/checked_decode.h"

namespace anchord {

/// Reads an LCM log, as lcm-logger writes it: events one after the other, each a header of 28 bytes
/// (big-endian: sync word, event number, utime, channel length, data length), the channel, the
/// data. Untrusted: liblcm's own reader allocates what a header claims, this one holds it against
/// limits first. Events of other channels are skipped, however large.
class LcmLogReader {
 public:
  /// Reads from the stream's position. The stream, opened as binary, must outlive the reader.
  explicit LcmLogReader(std::istream& stream) : stream_(stream) {}

  /// The data of the next event on `channel`; nothing at the end of the log. Refused, from then on
  /// for good: a header that is none, a log that ends inside an event; refused once: data of more
  /// than kMaxMessageBytes.
  Result<std::optional<std::vector<std::uint8_t>>> next(const std::string& channel);

  /// The next frame on kDetectionsChannel. Refused besides: what decode_frame() refuses; reading
  /// can go on after that. The field starts with the event's index: `event[12].sensor`.
  Result<std::optional<FrameMessage>> next_frame();

  /// The next frame on kDetectionsChannel or event on kEventChannel, in the log's order. Refused
  /// besides: what decode_frame() and decode_event() refuse, as next_frame() does.
  Result<std::optional<std::variant<Frame, Event>>> next_input();

  /// The same, or a note of an exported log on kReplayChannel, as the text that it is.
  Result<std::optional<std::variant<Frame, Event, std::string>>> next_item();

  /// How many events have been read, those of other channels included.
  std::int64_t events() const { return events_; }

 private:
  struct Message {
    std::string channel;
    std::vector<std::uint8_t> data;
  };
  Result<std::optional<Message>> next_of(std::initializer_list<std::string_view> channels);
  /// A refusal of what the last event holds.
  Error at_event(Error error) const;
  /// The refusal that every later call repeats.
  Error damage(const char* message);

  std::istream& stream_;
  std::int64_t events_ = 0;
  std::optional<Error> damage_;
};

/// Writes an LCM log that lcm-logplayer and LcmLogReader read.
class LcmLogWriter {
 public:
  /// The stream, opened as binary, must outlive the writer.
  explicit LcmLogWriter(std::ostream& stream) : stream_(stream) {}

  /// Appends an event; `utime` is when it came in. Fails if the stream does.
  Status write(const std::string& channel, Utime utime, std::span<const std::uint8_t> data);

  /// Appends a frame on kDetectionsChannel, at its own time, numbered from 1.
  Status write_frame(const Frame& frame);

  /// Appends an event on kEventChannel, likewise.
  Status write_event(const Event& event);

 private:
  std::ostream& stream_;
  std::int64_t events_ = 0;
  std::int64_t frames_ = 0;
  std::int64_t done_ = 0;  ///< events on kEventChannel
};

}  // namespace anchord
