#include "daemon/refold.h"

#include <utility>

#include "anchoring/checkpoint.h"
#include "anchoring/reconfigure.h"
#include "api/logged.h"

namespace anchord {

Result<Refold> Refold::begin(LogReader& log, Configurations& configurations) {
  const auto base = log.base();
  if (!base) return base.error();
  if (*base) return from((*base)->checkpoint, log, configurations);
  auto empty = configurations.empty(0);
  if (!empty) return empty.error();
  return Refold(*std::move(empty), 0, 0, configurations);
}

Result<Refold> Refold::from(const StoredCheckpoint& checkpoint, LogReader& log,
                            Configurations& configurations) {
  const auto last = log.at(checkpoint.sequence);
  if (!last) return last.error();
  if (!*last || checksum(**last) != checkpoint.frame_checksum)
    return invalid("", "belongs to another log");
  if (!configurations.made(checkpoint.configuration, checkpoint.sequence))
    return invalid("", "belongs to another configuration");
  const std::size_t index = configurations.at(checkpoint.sequence);
  auto world = configurations.empty(index);
  if (!world) return world.error();
  auto state = read_checkpoint(checkpoint.bytes, *world);
  if (!state) return state.error();
  if (state->taken != checkpoint.sequence) return invalid("", "counts otherwise than the log");
  std::vector<Accepted> recent;
  for (const WorldState::Step& step : state->recent) {
    const auto logged = log.at(step.number);
    if (!logged) return logged.error();
    if (!*logged) return invalid("", "needs a frame that is not in the log");
    auto accepted = read_logged(**logged);
    if (!accepted) return accepted.error();
    recent.push_back(*std::move(accepted));
  }
  if (Status resumed = world->resume(*std::move(state), recent); !resumed) return resumed.error();
  return Refold(*std::move(world), index, checkpoint.sequence, configurations);
}

Status Refold::take(const LoggedFrame& logged) {
  if (const std::size_t index = configurations_->at(logged.sequence); index != index_) {
    auto empty = configurations_->empty(index);
    if (!empty) return empty.error();
    auto changed = reconfigured(world_, *empty);
    if (!changed) return changed.error();
    world_ = *std::move(changed);
    index_ = index;
  }
  const auto accepted = read_logged(logged);
  world_.count_from(logged.sequence);
  return accepted ? apply(world_, *accepted) : Status(accepted.error());
}

Result<World> Refold::under_the_present() const {
  const auto& now = configurations_->now();
  if (world_.background() == now.background()) return world_;
  return reconfigured(world_, now);
}

}  // namespace anchord
