#include "daemon/lcm_child.h"

#include <fcntl.h>
#include <linux/sock_diag.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "api/lcm_bus.h"
#include "daemon/lcm_records.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/names.h"
#include "lcmtypes/verification_codec.h"

namespace anchord {
namespace {

/// Messages of a channel that may wait in liblcm: most of a second of 5000 frames.
constexpr int kQueuedInLcm = 4096;
/// Bytes that may wait for the daemon, and as many that are on their way to it.
constexpr std::size_t kWaitingBytes = 2 * kMaxMessageBytes;
/// liblcm keeps every channel's name that was ever heard, and allocates whatever size a message's
/// first fragment claims, up to 256 MiB. This is what ends it; a frame takes at most 8 MiB.
constexpr rlim_t kMemoryBytes = 128u << 20;
constexpr rlim_t kFiles = 64;
constexpr std::chrono::milliseconds kTellDrops{200};

/// Gives up what receiving does not need.
void shed() {
  prctl(PR_SET_NAME, "anchord-lcm");
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  // Whoever ends the daemon's group means the daemon, which is to finish what has begun.
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  const rlimit files{kFiles, kFiles};
  setrlimit(RLIMIT_NOFILE, &files);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // whose shadows are larger
  const rlimit memory{kMemoryBytes, kMemoryBytes};
  setrlimit(RLIMIT_DATA, &memory);
#endif
  const int first_to_go = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (first_to_go >= 0) {
    [[maybe_unused]] const auto written = write(first_to_go, "1000", 4);
    close(first_to_go);
  }
  // Ten dumps a second could fill the disk. After the above: it gives /proc/self to root.
  prctl(PR_SET_DUMPABLE, 0);
}

/// Datagrams that the kernel has dropped for want of room since the sockets were made.
std::uint64_t dropped_by_kernel() {
  std::uint64_t sum = 0;
  for (int file = kDaemonSocket + 1; file < static_cast<int>(kFiles); ++file) {
    int domain = 0;
    socklen_t size = sizeof domain;
    if (getsockopt(file, SOL_SOCKET, SO_DOMAIN, &domain, &size) != 0 || domain != AF_INET) continue;
    std::uint32_t memory[SK_MEMINFO_VARS] = {};
    size = sizeof memory;
    if (getsockopt(file, SOL_SOCKET, SO_MEMINFO, memory, &size) == 0)
      sum += memory[SK_MEMINFO_DROPS];
  }
  return sum;
}

bool send_all(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(kDaemonSocket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

bool send_record(const LcmRecord& record) {
  std::vector<std::uint8_t> bytes;
  append(record, bytes);
  return send_all(bytes);
}

/// What waits for the daemon. It is filled without ever waiting, so that liblcm goes on reading.
class Outbox {
 public:
  Outbox() { waiting_.reserve(kWaitingBytes); }

  void add(const LcmRecord& record) {
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.size() + record.bytes.size() > kWaitingBytes) {
        ++drops_.waiting;
        return;
      }
      append(record, waiting_);
    }
    wake_.notify_one();
  }

  /// Sends what is added, and how much was dropped, until nobody reads it any more.
  void send_on() {
    std::vector<std::uint8_t> going;
    going.reserve(kWaitingBytes);
    std::uint64_t kernel_before = 0;
    auto told = std::chrono::steady_clock::now();
    do {
      going.clear();
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, kTellDrops, [&] { return !waiting_.empty(); });
      going.swap(waiting_);
      const auto now = std::chrono::steady_clock::now();
      if (now - told < kTellDrops) continue;
      told = now;
      LcmDrops drops = std::exchange(drops_, {});
      lock.unlock();
      const std::uint64_t kernel = dropped_by_kernel();
      drops.by_kernel = kernel - std::exchange(kernel_before, kernel);
      if (drops.waiting + drops.by_kernel > 0)
        append({LcmRecord::Kind::kDrops, 0, drops_bytes(drops)}, going);
    } while (send_all(going));
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::uint8_t> waiting_;
  LcmDrops drops_;
};

template <auto decode>
Status check(std::span<const std::uint8_t> bytes) {
  const auto message = decode(bytes);
  return message ? Status(Done{}) : Status(message.error());
}

/// In the order of kReceivedChannels.
constexpr std::array<Status (*)(std::span<const std::uint8_t>), kReceivedChannels.size()> kChecks =
    {check<decode_frame>,  check<decode_event>, check<decode_trigger>,
     check<decode_result>, check<decode_pose>,  check<decode_query>};

Status subscribe(LcmBus& bus, Outbox& outbox) {
  for (std::uint8_t i = 0; i < kReceivedChannels.size(); ++i) {
    const auto pass_on = [&outbox, i](std::span<const std::uint8_t> bytes) {
      if (const Status good = kChecks[i](bytes); good)
        outbox.add({LcmRecord::Kind::kMessage, i, bytes});
      else
        outbox.add({LcmRecord::Kind::kRefused, i, refusal_bytes(good.error())});
    };
    if (Status s = bus.subscribe(kReceivedChannels[i], pass_on, kQueuedInLcm); !s) return s;
  }
  return Done{};
}

/// An LCM log that is written holds nothing to hear, and to open it here would empty it.
bool only_written(const std::string& url) {
  return url.starts_with("file://") &&
         (url.find("mode=w") != std::string::npos || url.find("mode=a") != std::string::npos);
}

int fail(const Error& why) {
  send_record({LcmRecord::Kind::kFailed,
               0,
               {reinterpret_cast<const std::uint8_t*>(why.message.data()), why.message.size()}});
  return 1;
}

}  // namespace

int receive_lcm(const std::string& url) {
  shed();
  spdlog::set_default_logger(spdlog::stderr_color_mt("anchord-lcm"));
  std::unique_ptr<LcmBus> bus;
  if (!only_written(url)) {
    auto opened = LcmBus::open(url);
    if (!opened) return fail(opened.error());
    bus = *std::move(opened);
  }
  char begin = 0;
  if (!send_record({LcmRecord::Kind::kJoined}) || recv(kDaemonSocket, &begin, 1, 0) != 1) return 1;
  Outbox outbox;
  if (bus) {
    if (const Status heard = subscribe(*bus, outbox); !heard) return fail(heard.error());
    bus->start();
  }
  outbox.add({LcmRecord::Kind::kHears});
  std::thread([] {
    char nothing = 0;
    while (recv(kDaemonSocket, &nothing, 1, 0) > 0) continue;
    _exit(0);  // the daemon is gone
  }).detach();
  outbox.send_on();
  _exit(0);
}

}  // namespace anchord
