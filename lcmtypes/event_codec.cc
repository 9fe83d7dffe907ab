#include "lcmtypes/event_codec.h"

#include <algorithm>
#include <anchord/event_t.hpp>

#include "lcmtypes/codec.h"
#include "lcmtypes/conversion.h"
#include "lcmtypes/wire_check.h"

namespace anchord {

Result<EventMessage> decode_event(std::span<const std::uint8_t> bytes) {
  const auto message = decode_checked<event_t>(check_event(bytes), bytes);
  if (!message) return message.error();
  EventMessage out;
  out.seq = message->seq;
  Event& event = out.event;
  event.kind = static_cast<Event::Kind>(message->kind);
  event.utime = message->utime;
  event.robot = message->robot;
  event.object = message->object;
  event.other = message->other;
  event.place = message->place;
  event.sensor = message->sensor;
  if (message->has_position) std::ranges::copy(message->position, event.position.emplace().begin());
  if (message->has_covariance) {
    std::ranges::copy(message->covariance, event.covariance.emplace().begin());
  }
  event.regions = from_lcm(message->regions);
  event.undone = message->undone;
  return out;
}

std::vector<std::uint8_t> encode(const Event& event, std::int64_t seq) {
  event_t message{};
  message.utime = event.utime;
  message.seq = seq;
  message.kind = static_cast<std::int8_t>(event.kind);
  message.robot = wire_text(event.robot);
  message.object = wire_text(event.object);
  message.other = wire_text(event.other);
  message.place = wire_text(event.place);
  message.sensor = wire_text(event.sensor);
  message.has_position = event.position.has_value();
  if (event.position) std::ranges::copy(*event.position, message.position);
  message.has_covariance = event.covariance.has_value();
  if (event.covariance) std::ranges::copy(*event.covariance, message.covariance);
  message.regions = to_lcm(event.regions);
  message.num_regions = static_cast<std::int32_t>(message.regions.size());
  message.undone = event.undone;
  return encode_message(message);
}

std::vector<std::uint8_t> canonical_bytes(const Event& event) { return encode(event, 0); }

}  // namespace anchord
