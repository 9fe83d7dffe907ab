#include "api/lcm_bus.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <utility>

namespace anchord {
namespace {

constexpr const char* kProviders[] = {"udpm://", "tcpq://", "memq://", "file://"};

constexpr char kDefaultUrl[] = "udpm://239.255.76.67:7667?ttl=0";
constexpr long kReceiveBufferBytes = 4L << 20;
constexpr int kQueuedMessages = 500;  // per channel, while a handler is busy; LCM's default is 30
constexpr int kRetryMs = 1000;

bool is_udpm(const std::string& url) { return url.rfind("udpm://", 0) == 0; }

}  // namespace

std::string effective_lcm_url(const std::string& requested) {
  std::string url = requested;
  if (url.empty()) {
    const char* from_environment = std::getenv("LCM_DEFAULT_URL");
    url = from_environment && *from_environment ? from_environment : kDefaultUrl;
  }
  if (is_udpm(url) && url.find("recv_buf_size") == std::string::npos) {
    // Asking for more than the kernel gives makes liblcm warn at every start.
    long kernel_limit = 0;
    std::ifstream("/proc/sys/net/core/rmem_max") >> kernel_limit;
    if (kernel_limit > 0) {
      url += url.find('?') == std::string::npos ? "?" : "&";
      url += "recv_buf_size=" + std::to_string(std::min(kReceiveBufferBytes, kernel_limit));
    }
  }
  return url;
}

Result<std::unique_ptr<LcmBus>> LcmBus::open(const std::string& requested) {
  std::string url = effective_lcm_url(requested);
  lcm_t* lcm = lcm_create(url.c_str());
  // liblcm joins the multicast group, and sends itself a message, only when asked for its file.
  if (!lcm || lcm_get_fileno(lcm) < 0) {
    if (lcm) lcm_destroy(lcm);
    std::string message = "cannot open the LCM network " + url;
    if (is_udpm(url)) {
      message +=
          ": there is no multicast route, or the address is wrong; add a route with "
          "`ip link set lo multicast on` and `ip route add 224.0.0.0/4 dev lo`";
    } else {
      message += "; LCM knows udpm://, tcpq://, memq:// and file:// URLs, and empty is its default";
    }
    const bool known = std::any_of(std::begin(kProviders), std::end(kProviders),
                                   [&](const char* provider) { return url.starts_with(provider); });
    return Error{known ? ErrorCode::kIo : ErrorCode::kInvalid, "lcm", message};
  }
  const int wake = eventfd(0, EFD_CLOEXEC);
  if (wake < 0) {
    lcm_destroy(lcm);
    return Error{ErrorCode::kIo, "lcm", "cannot make an eventfd: too many open files"};
  }
  return std::unique_ptr<LcmBus>(new LcmBus(std::move(url), lcm, wake));
}

LcmBus::LcmBus(std::string url, lcm_t* lcm, int wake)
    : url_(std::move(url)), lcm_(lcm), wake_(wake) {}

LcmBus::~LcmBus() {
  stop();
  close(wake_);
}

Status LcmBus::subscribe(const std::string& channel, Handler handler) {
  auto subscription = std::make_unique<Subscription>(Subscription{channel, std::move(handler)});
  lcm_subscription_t* made =
      lcm_subscribe(lcm_.get(), channel.c_str(), &LcmBus::dispatch, subscription.get());
  if (!made) return Error{ErrorCode::kIo, "lcm", "cannot subscribe to " + channel};
  lcm_subscription_set_queue_capacity(made, kQueuedMessages);
  subscriptions_.push_back(std::move(subscription));
  return Done{};
}

void LcmBus::start() {
  thread_ = std::thread([this] { receive(); });
}

void LcmBus::stop() {
  if (!thread_.joinable()) return;
  eventfd_write(wake_, 1);
  // Where liblcm's file is a socket (tcpq) it may be waiting there for the rest of a message.
  shutdown(lcm_get_fileno(lcm_.get()), SHUT_RDWR);
  thread_.join();
}

Status LcmBus::publish(const std::string& channel, std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(publishing_);
  const auto size = static_cast<unsigned>(bytes.size());
  if (lcm_publish(lcm_.get(), channel.c_str(), bytes.data(), size) != 0) {
    return Error{ErrorCode::kIo, "lcm", "cannot publish on " + channel};
  }
  return Done{};
}

void LcmBus::dispatch(const lcm_recv_buf_t* received, const char* /*channel*/, void* subscription) {
  const auto& [channel, handler] = *static_cast<const Subscription*>(subscription);
  try {
    handler({static_cast<const std::uint8_t*>(received->data), received->data_size});
  } catch (const std::exception& error) {  // must not pass through liblcm's C frames
    spdlog::error("LCM {}: the handler failed: {}", channel, error.what());
  } catch (...) {
    spdlog::error("LCM {}: the handler failed", channel);
  }
}

bool LcmBus::woken_within(int timeout_ms) const {
  pollfd wake{wake_, POLLIN, 0};
  return poll(&wake, 1, timeout_ms) > 0;
}

void LcmBus::receive() {
  // Not lcm_handle_timeout(): its select() cannot watch files above 1023.
  bool failing = false;
  while (true) {
    pollfd files[2] = {{wake_, POLLIN, 0}, {lcm_get_fileno(lcm_.get()), POLLIN, 0}};
    const bool connected = files[1].fd >= 0;
    if (poll(files, 2, connected ? -1 : 0) < 0 && errno != EINTR) return;
    if (files[0].revents) return;
    if (connected && !files[1].revents) continue;
    if (lcm_handle(lcm_.get()) == 0) {  // one message; reconnects where that can be done
      failing = false;
      continue;
    }
    if (!failing) spdlog::error("LCM {}: receiving failed; will try again", url_);
    failing = true;
    if (woken_within(kRetryMs)) return;
  }
}

}  // namespace anchord
