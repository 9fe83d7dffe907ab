#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/result.h"

namespace anchord {

/// An event as it came over LCM.
struct EventMessage {
  Event event;
  std::int64_t seq = 0;  ///< counts up by 1 for each event of its publisher, from 1; 0: not
                         ///< numbered
};

/// The event in an encoded event_t. The bytes are untrusted: see check_event() for what is refused.
/// Which members a kind needs, and what the numbers mean, is checked where they are used.
///
/// What the message's own flags leave unused (the position without has_position, the polygon of an
/// ellipsoid) is not looked at and has its default in the Event.
Result<EventMessage> decode_event(std::span<const std::uint8_t> bytes);

/// The event as an encoded event_t. Canonical, as the encoding of a frame is (lcmtypes/codec.h),
/// and with the same demands on the event.
std::vector<std::uint8_t> encode(const Event& event, std::int64_t seq);

/// What the log stores, and what two events are compared by: encode() without a number.
std::vector<std::uint8_t> canonical_bytes(const Event& event);

}  // namespace anchord
