// What the journal takes from the log at a start, and what it leaves there beside frames.

#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

#include "daemon/journal.h"
#include "daemon/refold.h"
#include "lcmtypes/verification_codec.h"

namespace anchord {

Status Journal::restore(const std::atomic<bool>& cancelled) {
  LogReader log = log_->reader();
  auto configurations = Configurations::of(log, world_);
  if (!configurations) return configurations.error();
  std::optional<Refold> fold;
  if (checkpointer_) fold = checkpointer_->resume(log, *configurations);
  if (!fold) {
    auto begun = Refold::begin(log, *configurations);
    if (!begun) return begun.error();
    fold = *std::move(begun);
  }
  resumed_ = fold->from_sequence();
  Status folded = Done{};
  Status read = log_->for_each(resumed_ + 1, [&](const LoggedFrame& logged) {
    const auto begin = Clock::now();
    folded = fold->take(logged);
    if (folded && hooks_.alive) hooks_.alive();
    if (folded) count_work(begin);
    if (folded && checkpointer_ && checkpointer_->due())  // should this start be killed, too
      checkpointer_->take(fold->world(), logged.sequence, checksum(logged));
    if (!folded)
      folded = Error{folded.error().code, folded.error().field,
                     folded.error().message + " (frame " + std::to_string(logged.sequence) +
                         " of the log does not fit this configuration: mend the configuration, "
                         "or start with another --data)"};
    return folded.ok() && !cancelled;
  });
  if (!read) return read;
  if (!folded || cancelled) return folded;
  auto present = fold->under_the_present();
  if (!present) return present.error();
  world_ = *std::move(present);
  sequence_ = durable_sequence_ = log_->last_sequence();
  const auto logged = log.configurations();
  if (!logged) return logged.error();
  configured_ = durable_configured_ = !logged->empty() && configurations->last_is_now();
  restored_late_ = world_.late_frames();
  durable_ = world_;
  published_ = world_.belief();
  first_ = log_->first_sequence();
  warn_of_the_future();
  return Done{};
}

/// A configuration stands in the log from its first frame or event on. The log of an older program
/// has none: all of it was folded under this one.
Status Journal::keep_configuration() {
  if (configured_) return Done{};
  LogReader log = log_->reader();
  const auto logged = log.configurations();
  if (!logged) return logged.error();
  const std::int64_t first = logged->empty() ? log_->first_sequence() : sequence_ + 1;
  if (Status kept = log_->put_configuration({first, background_->knowledge.text}); !kept)
    return kept;
  configured_ = true;
  return Done{};
}

/// What is to be known of the past later, and what need not be any more.
Status Journal::keep_past() {
  LogReader log = log_->reader();
  const auto samples = recorder_.look(world_.settled(), *background_, [&](const std::string& id) {
    const auto last = log.last_sample(id);
    return last ? *last : std::nullopt;
  });
  for (const HistorySample& sample : samples)
    if (Status kept = log_->put_sample(sample); !kept) return kept;
  return retention_.step(*log_, checkpointer_.get(), world_.belief()->utime);
}

Result<std::vector<Task>> Journal::tasks() {
  std::vector<Task> out;
  const Status read =
      log_->for_each_task([&](std::int64_t id, std::span<const std::uint8_t> bytes) {
        auto message = decode_task(bytes);
        if (message)
          out.push_back(std::move(message->task));
        else  // the belief does not hang on it
          spdlog::warn("task {} of the log cannot be read and is left out: {}", id,
                       message.error().text());
        return true;
      });
  if (!read) return read.error();
  return out;
}

}  // namespace anchord
