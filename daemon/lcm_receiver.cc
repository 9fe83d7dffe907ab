#include "daemon/lcm_receiver.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "daemon/lcm_child.h"

namespace anchord {
namespace {

using std::chrono::milliseconds;

/// liblcm waits 10 s for its own message to come back when it opens a network.
constexpr milliseconds kOpening{15'000};
/// Between two starts, at least: what kills it may come again and again.
constexpr milliseconds kBetweenStarts{50};
/// The same where it does not come to receive at all: doubled each time, up to the second.
constexpr milliseconds kFirstPause{100}, kLongestPause{5'000};
constexpr milliseconds kBetweenWarnings{1'000};
constexpr std::size_t kReadBytes = 256u << 10;

}  // namespace

Result<std::unique_ptr<LcmReceiver>> LcmReceiver::open(std::string program, std::string url) {
  const int wake = eventfd(0, EFD_CLOEXEC);
  if (wake < 0) return Error{ErrorCode::kIo, "lcm", "cannot make an eventfd: too many open files"};
  std::unique_ptr<LcmReceiver> receiver(new LcmReceiver(std::move(program), std::move(url), wake));
  if (Status spawned = receiver->spawn(); !spawned) return spawned.error();
  receiver->await([&] { return receiver->joined_; });
  if (!receiver->joined_) return Error{ErrorCode::kIo, "lcm", receiver->why_};
  return receiver;
}

LcmReceiver::LcmReceiver(std::string program, std::string url, int wake)
    : program_(std::move(program)), url_(std::move(url)), wake_(wake) {}

LcmReceiver::~LcmReceiver() {
  stop();
  close(wake_);
}

void LcmReceiver::start(Handler handler) {
  handler_ = std::move(handler);
  begin();
  await([this] { return counters_.receiving.load(); });
  thread_ = std::thread([this] { run(); });
}

/// Passes on until `condition` holds or the child has ended, for which there is a reason then.
void LcmReceiver::await(const std::function<bool()>& condition) {
  const auto give_up = Clock::now() + kOpening;
  while (child_ && !condition()) {
    pollfd file{child_->socket(), POLLIN, 0};
    const auto left = std::chrono::duration_cast<milliseconds>(give_up - Clock::now());
    if (left.count() > 0 && poll(&file, 1, static_cast<int>(left.count())) != 0) {
      pass_on();
    } else {
      why_ = "the process that receives LCM does not come up";
      ended();
    }
  }
}

void LcmReceiver::stop() {
  if (!thread_.joinable()) return;
  eventfd_write(wake_, 1);
  thread_.join();
}

bool LcmReceiver::woken_within(milliseconds time) const {
  pollfd wake{wake_, POLLIN, 0};
  return poll(&wake, 1, static_cast<int>(time.count())) > 0;
}

Status LcmReceiver::spawn() {
  records_ = {};
  why_.clear();
  joined_ = false;
  spawned_ = Clock::now();
  auto child = ChildProcess::start(program_, {kReceiveLcm, url_}, kDaemonSocket);
  if (!child) return child.error();
  child_ = *std::move(child);
  return Done{};
}

void LcmReceiver::begin() {
  constexpr char kBegin = 1;
  send(child_->socket(), &kBegin, 1, MSG_NOSIGNAL);  // if it has ended that is seen elsewhere
}

void LcmReceiver::run() {
  while (true) {
    if (child_) {
      pollfd files[2] = {{wake_, POLLIN, 0}, {child_->socket(), POLLIN, 0}};
      if (poll(files, 2, -1) < 0 && errno != EINTR) break;
      if (files[0].revents) break;
      if (files[1].revents) pass_on();
      if (child_) continue;
    }
    const auto since = std::chrono::duration_cast<milliseconds>(Clock::now() - spawned_);
    auto pause = std::max(kBetweenStarts - since, milliseconds(0));
    if (failures_ > 0)
      pause = std::min(kFirstPause * (1 << std::min(failures_ - 1, 6)), kLongestPause);
    if (woken_within(pause)) break;
    ++counters_.restarts;
    if (Status spawned = spawn(); spawned) {
      begin();
    } else {
      why_ = spawned.error().text();
      ended();
    }
  }
  counters_.receiving = false;
  child_.reset();
}

/// Reads once, and takes what is whole; without a child_ after it if that has ended.
void LcmReceiver::pass_on() {
  buffer_.resize(kReadBytes);
  const ssize_t size = recv(child_->socket(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (size <= 0) return ended();
  records_.add({buffer_.data(), static_cast<std::size_t>(size)});
  while (true) {
    const auto record = records_.next();
    if (!record) {
      why_ = record.error().text();
      return ended();
    }
    if (!*record) return;
    take(**record);
  }
}

void LcmReceiver::take(const LcmRecord& record) {
  switch (record.kind) {
    case LcmRecord::Kind::kJoined:
      joined_ = true;
      return;
    case LcmRecord::Kind::kHears:
      if (std::exchange(failures_, 0) > 0) spdlog::info("LCM is received again");
      counters_.receiving = true;
      return;
    case LcmRecord::Kind::kFailed:
      why_.assign(record.bytes.begin(), record.bytes.end());
      return;
    case LcmRecord::Kind::kDrops: {
      const LcmDrops more = drops(record.bytes);
      counters_.dropped += more.waiting;
      counters_.dropped_by_kernel += more.by_kernel;
      return;
    }
    case LcmRecord::Kind::kMessage:
    case LcmRecord::Kind::kRefused:
      break;
  }
  if (!handler_) return;
  try {
    handler_(record);
  } catch (const std::exception& error) {
    spdlog::error("LCM {}: the handler failed: {}", kReceivedChannels[record.channel],
                  error.what());
  }
}

void LcmReceiver::ended() {
  const std::string how = child_ ? child_->end() : "not started";
  child_.reset();
  counters_.receiving = false;
  if (std::exchange(joined_, false)) {
    if (Clock::now() - told_ < kBetweenWarnings) return;
    told_ = Clock::now();
    spdlog::warn(
        "the process that receives LCM has died ({}) and is started again; {} times so far",
        why_.empty() ? how : why_, counters_.restarts + 1);
    return;
  }
  if (why_.empty()) why_ = "the process that receives LCM ended at once (" + how + ")";
  if (handler_ && ++failures_ == 1)  // said once: it is tried again and again
    spdlog::error("LCM is not received: {}; trying again, at least every {} s", why_,
                  kLongestPause.count() / 1000);
}

}  // namespace anchord
