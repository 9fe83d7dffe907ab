#include "daemon/past.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

namespace anchord {
namespace {

/// How long a batch that is being written is waited for.
constexpr std::chrono::milliseconds kWait{200};

}  // namespace

Result<LogReader*> Past::log() {
  if (!log_) {
    auto log = LogReader::open(directory_);
    if (!log) return log.error();
    log_.emplace(*std::move(log));
  }
  return &*log_;
}

Status Past::await(std::int64_t least) {
  const auto end = std::chrono::steady_clock::now() + kWait;
  for (;;) {
    const auto last = log_->last_sequence();
    if (!last) return last.error();
    if (*last >= least || std::chrono::steady_clock::now() >= end) return Done{};
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
}

Result<Snapshot> Past::at(Utime utime, std::int64_t least) {
  const auto known = ask(utime, least);
  if (!known) return known.error();
  const World& world = (*known)->fold.world();
  return Snapshot{world.belief(), world.background()};
}

Result<Past::Then> Past::world_at(Utime utime, std::int64_t least) {
  const auto known = ask(utime, least);
  if (!known) return known.error();
  return Then{(*known)->fold.world(), (*known)->next};
}

Result<const Past::Known*> Past::ask(Utime utime, std::int64_t least) {
  if (auto opened = log(); !opened) return opened.error();
  if (Status there = await(least); !there) return there.error();
  // Only the last one can have become another: the first frame under it is its beginning.
  auto configurations = Configurations::of(*log_, now_);
  if (!configurations) return configurations.error();
  if (!configurations_ || configurations_->last() != configurations->last()) {
    known_.clear();
    configurations_ = std::make_unique<Configurations>(*std::move(configurations));
  }
  auto known = reach(utime);
  // The log's beginning may just have been given up.
  if (!known && known.error().code == ErrorCode::kConflict) {
    known_.clear();
    known = reach(utime);
  }
  if (!known) return known.error();
  known_.push_front(*std::move(known));
  if (known_.size() > kKnown) known_.pop_back();
  return &known_.front();
}

Result<Past::Known> Past::reach(Utime utime) {
  auto known = nearest(utime);
  if (!known) return known;
  if (Status gone_on = go_on(*known, utime); !gone_on) return gone_on.error();
  return known;
}

/// The latest of what is known and of the checkpoints that holds nothing after `utime`.
Result<Past::Known> Past::nearest(Utime utime) {
  const auto base = log_->base();
  if (!base) return base.error();
  const Utime begins = *base ? (*base)->checkpoint.utime : 0;
  if (utime < begins)
    return Error{ErrorCode::kUnknown, "at",
                 "lies before " + std::to_string(begins) +
                     ", from when on the log is kept; /v1/history goes back further"};
  const Known* best = nullptr;
  for (const Known& known : known_)
    if (known.until <= utime && (!best || known.until > best->until)) best = &known;

  if (!checkpoints_)
    if (auto store = CheckpointStore::open(directory_); store)
      checkpoints_.emplace(*std::move(store));
  std::int64_t before = std::numeric_limits<std::int64_t>::max();
  while (checkpoints_) {
    const auto checkpoint = checkpoints_->newest_until(utime, before);
    if (!checkpoint || !*checkpoint || (best && (*checkpoint)->utime <= best->until)) break;
    auto fold = Refold::from(**checkpoint, *log_, *configurations_);
    before = (*checkpoint)->sequence;
    if (fold) return Known{*std::move(fold), (*checkpoint)->utime, before + 1, before};
  }
  if (best) return *best;
  auto fold = Refold::begin(*log_, *configurations_);
  if (!fold) return fold.error();
  const std::int64_t next = fold->from_sequence() + 1;
  return Known{*std::move(fold), begins, next, next - 1};
}

/// Takes all that is later than what is known and not later than `utime`. When the newest frame is
/// later than that by more than frames may be late, no more can come.
Status Past::go_on(Known& known, Utime utime) {
  Status taken = Done{};
  std::optional<std::int64_t> later;  ///< the first that is left out
  Utime newest = known.fold.world().belief()->utime;
  const Status read = log_->for_each(known.next, [&](const LoggedFrame& logged) {
    const Utime lateness = from_seconds(known.fold.world().background()->knowledge.max_lateness);
    const bool event = logged.kind == LoggedFrame::Kind::kEvent;
    const Utime order =
        event && logged.utime - newest > lateness && newest > 0 ? newest : logged.utime;
    if (!event) newest = std::max(newest, logged.utime);
    if (order > utime) {
      if (!later) later = logged.sequence;
    } else if (order > known.until || logged.sequence > known.seen) {
      taken = known.fold.take(logged);
    }
    known.seen = std::max(known.seen, logged.sequence);
    return taken.ok() && newest - lateness <= utime;
  });
  if (!read) return read;
  if (!taken) return taken;
  known.until = utime;
  known.next = later.value_or(known.seen + 1);
  return Done{};
}

}  // namespace anchord
