#include "daemon/journal.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "api/logged.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/verification_codec.h"

namespace anchord {

Journal::Journal(World world, std::unique_ptr<FrameLog> log, Statistics& statistics,
                 UpdateTimes& times, Hooks hooks, std::unique_ptr<Checkpointer> checkpointer)
    : world_(std::move(world)),
      durable_(world_),
      background_(world_.background()),
      log_(std::move(log)),
      statistics_(statistics),
      times_(times),
      pace_(background_->knowledge.limits.frame_budget),
      hooks_(std::move(hooks)),
      checkpointer_(std::move(checkpointer)),
      recorder_(background_->knowledge.log.history_grain),
      retention_(background_->knowledge.log),
      published_(world_.belief()) {}

Journal::~Journal() {
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
    ends_ = Clock::now() + kEnding;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

/// What folding since then would take at a start, about.
void Journal::count_work(Clock::time_point begin) {
  if (checkpointer_)
    checkpointer_->worked(std::chrono::duration<double>(Clock::now() - begin).count());
}

void Journal::start() {
  thread_ = std::thread([this] { run(); });
}

bool Journal::submit(Submission submission) {
  {
    std::lock_guard lock(mutex_);
    if (ending_ || !intake_.enter(submission.size(), submission.bytes, Clock::now())) return false;
    queue_.push_back(std::move(submission));
  }
  wake_.notify_one();
  return true;
}

Intake::State Journal::waiting() const {
  const std::lock_guard lock(mutex_);
  return intake_.state(Clock::now());
}

void Journal::run() {
  std::unique_lock lock(mutex_);
  while (!ending_ || !queue_.empty() || batch_open_) {
    const auto deadline =
        batch_open_ ? batch_began_ + kBatch : Clock::now() + std::chrono::milliseconds(500);
    wake_.wait_until(lock, deadline, [&] { return ending_ || !queue_.empty(); });
    if (hooks_.alive) hooks_.alive();
    if (!queue_.empty()) {
      Submission submission = std::move(queue_.front());
      queue_.pop_front();
      intake_.leave(submission.size(), submission.bytes, Clock::now());
      const bool too_late = ending_ && Clock::now() >= ends_;
      lock.unlock();
      if (too_late)
        refuse(submission, nullptr,
               {ErrorCode::kUnavailable, "", "the daemon ends; send this again later"});
      else
        take(std::move(submission));
      lock.lock();
    }
    if (commit_is_due()) {
      lock.unlock();
      commit();
      lock.lock();
    }
  }
}

bool Journal::commit_is_due() const {
  if (!batch_open_) return false;
  return Clock::now() >= batch_began_ + kBatch || (queue_.empty() && (awaited_ || ending_));
}

/// All of the submission or none.
void Journal::take(Submission submission) {
  const auto begin = Clock::now();
  std::optional<World> before;  // only several can fail half-way
  if (submission.size() > 1) before = world_;
  std::vector<Folded> folded;
  Receipt receipt;
  for (std::size_t i = 0; i < submission.frames.size(); ++i) {
    const Status done = fold(submission.frames[i], folded);
    if (done) continue;
    if (before) world_ = *std::move(before);
    Error why = done.error();
    if (submission.array)
      why.field = "[" + std::to_string(i) + "]" + (why.field.empty() ? "" : ".") + why.field;
    return refuse(submission, &submission.frames[i], why);
  }
  receipt.accepted = folded.size();
  receipt.repeated = submission.frames.size() - folded.size();
  for (const Event& event : submission.events)
    if (const Status done = fold(event, folded, receipt); !done) {
      if (before) world_ = *std::move(before);
      return refuse(submission, nullptr, done.error());
    }
  for (const Task& task : submission.tasks)
    if (const auto readable = decode_task(canonical_bytes(task)); !readable) {
      if (!folded.empty()) world_ = *std::move(before);
      return refuse(submission, nullptr, readable.error());
    }
  if (Status logged = append(folded, submission.tasks); !logged) {
    roll_back(logged.error());
    return refuse(submission, nullptr, logged.error());
  }
  count_work(begin);
  for (const Folded& one : folded) publish(one.after);

  if (!batch_open_) {  // all of it is durable already
    statistics_.repeated += receipt.repeated;
    if (submission.done) submission.done(receipt);
    return;
  }
  awaited_ = awaited_ || submission.done;
  pending_.push_back({std::move(submission), receipt});
}

namespace {

/// The log's encoding has room for three numbers always: what is missing would pass for zeros.
Status check_positions(const Frame& frame, int dims) {
  for (std::size_t i = 0; i < frame.detections.size(); ++i) {
    const auto* measured = std::get_if<CartesianMeasurement>(&frame.detections[i].measurement);
    if (measured && static_cast<int>(measured->position.size()) < dims)
      return invalid("detections[" + std::to_string(i) + "].position",
                     "must have " + std::to_string(dims) + " numbers");
  }
  return Done{};
}

}  // namespace

/// Adds to `folded` unless the frame is in the log, or there, already.
Status Journal::fold(const Frame& frame, std::vector<Folded>& folded) {
  if (Status whole = check_positions(frame, background_->dims); !whole) return whole;
  LoggedFrame logged{LoggedFrame::Kind::kFrame, 0, frame.utime, frame.robot, frame.sensor,
                     canonical_bytes(frame)};
  if (const auto newest = world_.newest(frame); newest && frame.utime <= *newest) {
    const auto again = repeated(logged, folded);
    if (!again) return again.error();
    if (*again) return Done{};
  }
  if (Status leap = check_leap(frame.utime); !leap) return leap;
  // What is folded is what a restart will read, to the bit; and what it could not is refused.
  const auto message = decode_frame(logged.bytes);
  if (!message) return message.error();
  const std::uint64_t late = world_.late_frames();
  const auto work = pace_.work();
  if (work) logged.work = static_cast<std::int64_t>(*work);
  const auto begin = Clock::now();
  if (Status applied = world_.apply(message->frame, work); !applied) {
    warn_of_the_future();
    return applied;
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  times_.add(seconds);
  if (world_.late_frames() == late) pace_.took(world_.belief()->effort.work, seconds);
  folded.push_back({std::move(logged), world_.belief()});
  return Done{};
}

Utime Journal::clock_time() {
  using std::chrono::microseconds;
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<microseconds>(since_1970).count();
}

/// One frame with a time far ahead would make all after it too late. The first frame of a log may
/// be of any time, and recordings of the past are: only what neither the frames nor the clock have
/// come near is refused.
Status Journal::check_leap(Utime utime) {
  const Utime newest = world_.belief()->utime;
  const double leap = seconds_between(std::max(newest, hooks_.now()), utime);
  const bool no_time = utime > kLatestUtime;  // the world says what is wrong with it
  if (newest == 0 || no_time || leap <= background_->knowledge.max_leap) return Done{};
  ++statistics_.ahead;
  return Error{ErrorCode::kConflict, "utime",
               "is " + std::to_string(std::llround(leap)) +
                   " s ahead of the newest frame and of the daemon's clock, more than "
                   "world.max_leap"};
}

/// The clock was ahead and has come back, or a recording from the future was played: what comes
/// now is too late.
void Journal::warn_of_the_future() {
  const double ahead = seconds_between(hooks_.now(), world_.belief()->utime);
  const bool far = ahead > background_->knowledge.max_leap;
  if (far && !warned_)
    spdlog::warn(
        "the newest frame is {:.0f} s ahead of this machine's clock: frames of the present are "
        "refused as too late. If a clock was wrong, stop the daemon and take that time back with "
        "`anchorctl repair DIR --until now`",
        ahead);
  warned_ = far;
}

/// The same for an event.
Status Journal::fold(const Event& event, std::vector<Folded>& folded, Receipt& receipt) {
  LoggedFrame logged{LoggedFrame::Kind::kEvent, 0, event.utime, event.robot, event.sensor,
                     canonical_bytes(event)};
  const auto again = log_->contains_event(event.utime, logged.bytes);
  if (!again) return again.error();
  if (*again) {
    receipt.events.push_back(0);
    return Done{};
  }
  const auto message = decode_event(logged.bytes);
  if (!message) return message.error();
  const auto number = world_.apply(message->event);
  if (!number) return number.error();
  receipt.events.push_back(*number);
  folded.push_back({std::move(logged), world_.belief()});
  return Done{};
}

/// Whether the log, or `folded`, has the frame; kConflict if it has another in its place.
Result<bool> Journal::repeated(const LoggedFrame& frame, const std::vector<Folded>& folded) {
  auto presence = FrameLog::Presence::kNo;
  const auto same_time = std::find_if(folded.begin(), folded.end(), [&](const Folded& one) {
    return one.frame.kind == frame.kind && one.frame.utime == frame.utime &&
           one.frame.sensor == frame.sensor && one.frame.robot == frame.robot;
  });
  if (same_time != folded.end()) {
    presence = same_time->frame.bytes == frame.bytes ? FrameLog::Presence::kSame
                                                     : FrameLog::Presence::kDifferent;
  } else {
    const auto logged = log_->contains(frame.robot, frame.sensor, frame.utime, frame.bytes);
    if (!logged) return logged.error();
    presence = *logged;
  }
  if (presence == FrameLog::Presence::kDifferent)
    return Error{ErrorCode::kConflict, "utime",
                 "this sensor has reported another frame with this utime"};
  return presence == FrameLog::Presence::kSame;
}

Status Journal::append(const std::vector<Folded>& folded, const std::vector<Task>& tasks) {
  if (folded.empty() && tasks.empty()) return Done{};
  if (!std::exchange(batch_open_, true)) batch_began_ = Clock::now();
  if (!folded.empty())
    if (Status kept = keep_configuration(); !kept) return kept;
  for (const Folded& one : folded) {
    LoggedFrame frame = one.frame;
    frame.sequence = ++sequence_;
    if (Status logged = log_->append(frame); !logged) return logged;
  }
  for (const Task& task : tasks)
    if (Status kept = log_->put_task(task.id, task.ended_already(), canonical_bytes(task)); !kept)
      return kept;
  return tasks.empty() ? Status(Done{}) : log_->keep_tasks(kTasks);
}

void Journal::commit() {
  if (Status kept = keep_past(); !kept) return roll_back(kept.error());
  if (Status done = log_->commit(); !done) return roll_back(done.error());
  if (std::exchange(failing_, false)) spdlog::info("frames are durable again");
  batch_open_ = awaited_ = false;
  durable_ = world_;
  durable_configured_ = configured_;
  take_checkpoint();
  durable_sequence_ = sequence_;
  first_ = log_->first_sequence();
  if (const auto size = log_->size()) {
    used_ = size->used;
    free_ = size->free;
  }
  ++statistics_.commits;
  statistics_.late = world_.late_frames() - restored_late_;
  for (Pending& pending : std::exchange(pending_, {})) {
    statistics_.accepted += pending.receipt.accepted;
    statistics_.repeated += pending.receipt.repeated;
    if (pending.submission.done) pending.submission.done(pending.receipt);
  }
}

void Journal::take_checkpoint() {
  if (!checkpointer_ || durable_sequence_ == sequence_ || !checkpointer_->due()) return;
  const auto begin = Clock::now();
  checkpointer_->take(durable_, sequence_, log_->last_checksum());
  const double pause = std::chrono::duration<double>(Clock::now() - begin).count();
  longest_pause_ = std::max(longest_pause_.load(), pause);
}

Journal::Kept Journal::kept() const {
  return {first_, used_, free_, checkpointer_ ? checkpointer_->bytes() : 0, longest_pause_};
}

/// The batch cannot be kept: the belief goes back to the last one that is durable.
void Journal::roll_back(const Error& why) {
  if (!std::exchange(failing_, true))
    spdlog::error("frames cannot be made durable and are refused: {}", why.text());
  log_->rollback();
  recorder_.forget();
  configured_ = durable_configured_;
  ++statistics_.commit_failures;
  batch_open_ = awaited_ = false;
  world_ = durable_;
  sequence_ = durable_sequence_;
  publish(world_.belief());
  for (Pending& pending : std::exchange(pending_, {})) refuse(pending.submission, nullptr, why);
}

void Journal::refuse(Submission& submission, const Frame* frame, const Error& why) {
  statistics_.refused += submission.frames.size();
  if (why.code == ErrorCode::kStorage) statistics_.unstored += submission.frames.size();
  if (!frame && submission.frames.size() == 1) frame = &submission.frames.front();
  if (hooks_.refused) hooks_.refused(submission, frame, why);
  if (submission.done) submission.done(why);
}

void Journal::publish(const std::shared_ptr<const Belief>& belief) {
  published_ = belief;
  if (hooks_.applied) hooks_.applied(belief);
}

}  // namespace anchord
