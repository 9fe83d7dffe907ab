#include "api/logged.h"

#include "lcmtypes/checked_decode.h"
#include "lcmtypes/event_codec.h"

namespace anchord {

Result<Accepted> read_logged(const LoggedFrame& logged) {
  if (logged.kind == LoggedFrame::Kind::kEvent) {
    auto message = decode_event(logged.bytes);
    if (!message) return message.error();
    return Accepted{std::move(message->event)};
  }
  auto message = decode_frame(logged.bytes);
  if (!message) return message.error();
  Accepted accepted{std::move(message->frame)};
  if (logged.work) accepted.work = static_cast<std::uint64_t>(*logged.work);
  return accepted;
}

Status apply(World& world, const Accepted& accepted) {
  if (const auto* frame = std::get_if<Frame>(&accepted.what))
    return world.apply(*frame, accepted.work);
  const auto number = world.apply(std::get<Event>(accepted.what));
  return number ? Status(Done{}) : Status(number.error());
}

}  // namespace anchord
