#include "daemon/checkpointer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <limits>
#include <utility>

#include "anchoring/checkpoint.h"

namespace anchord {
namespace {

/// Of the time that frames take, as much may go into checkpoints.
constexpr double kShare = 0.1;

/// The latest time of what is in it.
Utime time_of(const WorldState& state, const Belief& before) {
  return state.recent.empty() ? before.utime : std::max(before.utime, state.recent.back().utime);
}

}  // namespace

Checkpointer::Checkpointer(const std::string& directory, World now, double interval)
    : directory_(directory), now_(std::move(now)), interval_(interval), worker_(4) {
  auto store = CheckpointStore::open(directory);
  if (!store) {
    spdlog::warn("checkpoints cannot be kept, a start will fold the whole log: {}",
                 store.error().text());
    return;
  }
  store_ = std::make_unique<CheckpointStore>(*std::move(store));
  if (const auto bytes = store_->bytes()) bytes_ = *bytes;
  if (const auto past = store_->newest_past()) last_past_ = *past;
}

std::optional<Refold> Checkpointer::resume(LogReader& log, Configurations& configurations) {
  if (!store_) return {};
  std::int64_t before = std::numeric_limits<std::int64_t>::max();
  for (;;) {
    const auto checkpoint = store_->newest(before);
    if (!checkpoint) {
      spdlog::warn("checkpoints cannot be read: {}", checkpoint.error().text());
      return {};
    }
    if (!*checkpoint) return {};
    auto resumed = Refold::from(**checkpoint, log, configurations);
    before = (*checkpoint)->sequence;
    if (resumed) {
      newest_ = before;
      return *std::move(resumed);
    }
    spdlog::warn("the checkpoint at frame {} is left out: {}", before, resumed.error().text());
  }
}

void Checkpointer::worked(double seconds) {
  since_ += seconds;
  work_ += seconds;
  ++count_;
}

bool Checkpointer::due() const {
  if (!store_ || writing_) return false;
  return demanded_ || interval_ <= 0 || since_ >= std::max(interval_, took_ / kShare);
}

void Checkpointer::take(const World& durable, std::int64_t sequence, std::uint32_t frame_checksum) {
  if (!due() || writing_.exchange(true)) return;
  since_ = 0;
  demanded_ = false;
  // Runs when the task has gone, whether or not it was done.
  const std::shared_ptr<void> end(nullptr, [this](void*) { writing_ = false; });
  const double seconds_per_frame = count_ > 0 ? work_ / static_cast<double>(count_) : 0;
  Taken taken{durable.state(), durable.background(), sequence, frame_checksum, seconds_per_frame};
  worker_.post([this, end, taken = std::move(taken)] { write(taken); });
}

void Checkpointer::finish() {
  std::promise<void> written;
  if (worker_.post([&] { written.set_value(); })) written.get_future().wait();
}

void Checkpointer::write(const Taken& taken) {
  const auto begin = std::chrono::steady_clock::now();
  const double since_past =
      static_cast<double>(taken.sequence - last_past_) * taken.seconds_per_frame;
  const bool past = last_past_ > taken.sequence || since_past >= kPastWork;
  const Status kept = store_->put(
      {taken.sequence, taken.frame_checksum, taken.background->knowledge.fingerprint,
       write_checkpoint(taken.state, *taken.background), time_of(taken.state, *taken.state.before)},
      past);
  took_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!kept) return spdlog::warn("a checkpoint cannot be kept: {}", kept.error().text());
  newest_ = taken.sequence;
  if (past) last_past_ = taken.sequence;
  if (const auto bytes = store_->bytes()) bytes_ = *bytes;
}

void Checkpointer::look_for_base(Utime until, std::int64_t sequence) {
  if (!store_) return;
  worker_.post([this, until, sequence] {
    auto found = sequence > 0
                     ? store_->oldest_from(sequence)
                     : store_->newest_until(until, std::numeric_limits<std::int64_t>::max());
    if (!found || !*found) return;
    auto log = LogReader::open(directory_);
    if (!log) return;
    auto configurations = Configurations::of(*log, now_);
    if (!configurations) return;
    const auto fold = Refold::from(**found, *log, *configurations);
    if (!fold) return;
    LogBase base{**std::move(found), fold->from_sequence() + 1};
    for (const WorldState::Step& step : fold->world().state().recent)
      base.first_kept = std::min(base.first_kept, step.number);
    const std::lock_guard lock(mutex_);
    base_ = std::move(base);
  });
}

std::optional<LogBase> Checkpointer::base() {
  const std::lock_guard lock(mutex_);
  return std::exchange(base_, {});
}

void Checkpointer::forget_before(std::int64_t sequence) {
  if (!store_) return;
  worker_.post([this, sequence] {
    if (Status forgotten = store_->forget_before(sequence); !forgotten)
      spdlog::warn("old checkpoints cannot be dropped: {}", forgotten.error().text());
    if (const auto bytes = store_->bytes()) bytes_ = *bytes;
  });
}

}  // namespace anchord
