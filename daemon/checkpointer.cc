#include "daemon/checkpointer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "anchoring/checkpoint.h"
#include "daemon/logged.h"

namespace anchord {
namespace {

/// Of the time that frames take, as much may go into checkpoints.
constexpr double kShare = 0.1;

/// The frame or event of that number, or nothing.
std::optional<LoggedFrame> at(FrameLog& log, std::int64_t sequence) {
  std::optional<LoggedFrame> found;
  if (sequence < 1 || sequence > log.last_sequence()) return found;
  const Status read = log.for_each(sequence, [&](const LoggedFrame& logged) {
    found = logged;
    return false;
  });
  return read ? found : std::nullopt;
}

Status resume_at(World& world, FrameLog& log, const StoredCheckpoint& checkpoint) {
  const auto last = at(log, checkpoint.sequence);
  if (!last || checksum(*last) != checkpoint.frame_checksum)
    return invalid("", "belongs to another log");
  auto state = read_checkpoint(checkpoint.bytes, world);
  if (!state) return state.error();
  if (state->taken != checkpoint.sequence) return invalid("", "counts otherwise than the log");
  std::vector<Accepted> recent;
  for (const WorldState::Step& step : state->recent) {
    const auto logged = at(log, step.number);
    if (!logged) return invalid("", "needs a frame that cannot be read");
    auto accepted = read_logged(*logged);
    if (!accepted) return accepted.error();
    recent.push_back(*std::move(accepted));
  }
  return world.resume(*std::move(state), recent);
}

}  // namespace

Checkpointer::Checkpointer(const std::string& directory,
                           std::shared_ptr<const Background> background, double interval)
    : background_(std::move(background)), interval_(interval), worker_(1) {
  auto store = CheckpointStore::open(directory);
  if (store)
    store_ = std::make_unique<CheckpointStore>(*std::move(store));
  else
    spdlog::warn("checkpoints cannot be kept, a start will fold the whole log: {}",
                 store.error().text());
}

std::int64_t Checkpointer::resume(World& world, FrameLog& log) {
  if (!store_) return 0;
  std::int64_t before = std::numeric_limits<std::int64_t>::max();
  for (;;) {
    const auto checkpoint = store_->newest(background_->knowledge.fingerprint, before);
    if (!checkpoint) {
      spdlog::warn("checkpoints cannot be read: {}", checkpoint.error().text());
      return 0;
    }
    if (!*checkpoint) return 0;
    const Status resumed = resume_at(world, log, **checkpoint);
    if (resumed) return newest_ = (*checkpoint)->sequence;
    before = (*checkpoint)->sequence;
    spdlog::warn("the checkpoint at frame {} is left out: {}", before, resumed.error().text());
  }
}

bool Checkpointer::due() const {
  return store_ && !writing_ && (interval_ <= 0 || since_ >= std::max(interval_, took_ / kShare));
}

void Checkpointer::take(const World& durable, std::int64_t sequence, std::uint32_t frame_checksum) {
  if (!due() || writing_.exchange(true)) return;
  since_ = 0;
  // Runs when the task has gone, whether or not it was done.
  const std::shared_ptr<void> end(nullptr, [this](void*) { writing_ = false; });
  worker_.post([this, end, state = durable.state(), sequence, frame_checksum] {
    write(state, sequence, frame_checksum);
  });
}

void Checkpointer::write(const WorldState& state, std::int64_t sequence,
                         std::uint32_t frame_checksum) {
  const auto begin = std::chrono::steady_clock::now();
  const Status kept = store_->put({sequence, frame_checksum, background_->knowledge.fingerprint,
                                   write_checkpoint(state, *background_)});
  took_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (kept)
    newest_ = sequence;
  else
    spdlog::warn("a checkpoint cannot be kept: {}", kept.error().text());
}

}  // namespace anchord
