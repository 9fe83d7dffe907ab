#include "daemon/journal.h"

#include <spdlog/spdlog.h>

#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"

namespace anchord {

Journal::Journal(World world, std::unique_ptr<FrameLog> log, Statistics& statistics,
                 UpdateTimes& times, Hooks hooks)
    : world_(std::move(world)),
      durable_(world_),
      log_(std::move(log)),
      statistics_(statistics),
      times_(times),
      hooks_(std::move(hooks)),
      published_(world_.belief()) {}

Journal::~Journal() {
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

Status Journal::restore(const std::atomic<bool>& cancelled) {
  Status folded = Done{};
  Status read = log_->for_each(1, [&](const LoggedFrame& logged) {
    const auto message = decode_frame(logged.bytes);
    folded = message ? world_.apply(message->frame) : Status(message.error());
    if (folded && hooks_.alive) hooks_.alive();
    if (!folded)
      folded = Error{folded.error().code, folded.error().field,
                     folded.error().message + " (frame " + std::to_string(logged.sequence) +
                         " of the log does not fit this configuration: mend the configuration, "
                         "or start with another --data)"};
    return folded.ok() && !cancelled;
  });
  if (!read) return read;
  if (!folded) return folded;
  sequence_ = durable_sequence_ = log_->last_sequence();
  durable_ = world_;
  published_ = world_.belief();
  return Done{};
}

void Journal::start() {
  thread_ = std::thread([this] { run(); });
}

bool Journal::submit(Submission submission) {
  {
    std::lock_guard lock(mutex_);
    if (ending_ || waiting_ + submission.frames.size() > kQueue) return false;
    waiting_ += submission.frames.size();
    queue_.push_back(std::move(submission));
  }
  wake_.notify_one();
  return true;
}

Snapshot Journal::snapshot() const { return {published_.load(), world_.background()}; }

void Journal::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    const auto deadline = batch_open_ ? batch_began_ + kBatch
                                      : Clock::now() + std::chrono::milliseconds(500);
    wake_.wait_until(lock, deadline, [&] { return ending_ || !queue_.empty(); });
    if (hooks_.alive) hooks_.alive();
    if (!queue_.empty()) {
      Submission submission = std::move(queue_.front());
      queue_.pop_front();
      waiting_ -= submission.frames.size();
      lock.unlock();
      take(std::move(submission));
      lock.lock();
    }
    if (batch_open_ && (Clock::now() >= batch_began_ + kBatch || (ending_ && queue_.empty()))) {
      lock.unlock();
      commit();
      lock.lock();
    }
    if (ending_ && queue_.empty() && !batch_open_) return;
  }
}

void Journal::take(Submission submission) {
  auto receipt = apply(submission);
  if (!receipt) return refuse(submission, receipt.error());
  if (!batch_open_) {  // nothing of it needs to be made durable
    if (submission.done) submission.done(*receipt);
    statistics_.repeated += receipt->repeated;
    return;
  }
  pending_.push_back({std::move(submission), *receipt});
}

/// All frames of the submission or none.
Result<Receipt> Journal::apply(const Submission& submission) {
  Receipt receipt;
  std::vector<const Frame*> applied;
  std::optional<World> before;  // only several frames can fail half-way
  if (submission.frames.size() > 1) before = world_;
  for (std::size_t i = 0; i < submission.frames.size(); ++i) {
    const Frame& frame = submission.frames[i];
    auto fresh = apply(frame);
    if (!fresh) {
      if (before) world_ = std::move(*before);
      publish();
      refused_frame_ = &frame;
      Error error = fresh.error();
      if (submission.array) error.field = "[" + std::to_string(i) + "]." + error.field;
      return error;
    }
    if (*fresh)
      applied.push_back(&frame);
    else
      ++receipt.repeated;
  }
  for (const Frame* frame : applied)
    if (Status logged = append(*frame); !logged) {
      roll_back(logged.error());
      return logged.error();
    }
  receipt.accepted = applied.size();
  return receipt;
}

/// True if the frame was applied, false if it is in the log already.
Result<bool> Journal::apply(const Frame& frame) {
  if (const auto newest = world_.newest(frame); newest && frame.utime <= *newest) {
    const auto presence =
        log_->contains(frame.robot, frame.sensor, frame.utime, canonical_bytes(frame));
    if (!presence) return presence.error();
    if (*presence == FrameLog::Presence::kSame) return false;
    if (*presence == FrameLog::Presence::kDifferent)
      return Error{ErrorCode::kConflict, "utime",
                   "this sensor has reported another frame with this utime"};
  }
  const auto begin = Clock::now();
  if (Status applied = world_.apply(frame); !applied) return applied.error();
  times_.add(std::chrono::duration<double>(Clock::now() - begin).count());
  publish();
  return true;
}

Status Journal::append(const Frame& frame) {
  if (!batch_open_) {
    batch_open_ = true;
    batch_began_ = Clock::now();
  }
  return log_->append({++sequence_, frame.utime, frame.robot, frame.sensor,
                       canonical_bytes(frame)});
}

void Journal::commit() {
  batch_open_ = false;
  if (Status done = log_->commit(); !done) return roll_back(done.error());
  ++statistics_.commits;
  durable_ = world_;
  durable_sequence_ = sequence_;
  for (Pending& pending : std::exchange(pending_, {})) {
    statistics_.accepted += pending.receipt.accepted;
    statistics_.repeated += pending.receipt.repeated;
    if (pending.submission.done) pending.submission.done(pending.receipt);
  }
  statistics_.late = world_.late_frames();
}

/// The batch cannot be kept: the belief goes back to the last one that is durable.
void Journal::roll_back(const Error& why) {
  spdlog::error("frames could not be made durable and are refused: {}", why.text());
  log_->rollback();
  ++statistics_.commit_failures;
  batch_open_ = false;
  world_ = durable_;
  sequence_ = durable_sequence_;
  publish();
  for (Pending& pending : std::exchange(pending_, {})) refuse(pending.submission, why);
}

void Journal::refuse(Submission& submission, const Error& why) {
  statistics_.refused += submission.frames.size();
  const Frame* frame = std::exchange(refused_frame_, nullptr);
  if (!frame && submission.frames.size() == 1) frame = &submission.frames.front();
  if (hooks_.refused) hooks_.refused(submission, frame, why);
  if (submission.done) submission.done(why);
}

void Journal::publish() {
  published_ = world_.belief();
  if (hooks_.applied) hooks_.applied(world_.belief());
}

}  // namespace anchord
