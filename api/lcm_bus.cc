#include "api/lcm_bus.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
#include <utility>

namespace anchord {
namespace {

constexpr int kRetryMs = 1000;

}  // namespace

Result<std::unique_ptr<LcmBus>> LcmBus::open(const std::string& url) {
  auto sender = LcmSender::open(url);
  if (!sender) return sender.error();
  // liblcm joins the multicast group, and sends itself a message, only when asked for its file.
  if (lcm_get_fileno((*sender)->lcm_.get()) < 0) return lcm_network_error((*sender)->url());
  const int wake = eventfd(0, EFD_CLOEXEC);
  if (wake < 0) return Error{ErrorCode::kIo, "lcm", "cannot make an eventfd: too many open files"};
  return std::unique_ptr<LcmBus>(new LcmBus(*std::move(sender), wake));
}

LcmBus::LcmBus(std::unique_ptr<LcmSender> sender, int wake)
    : sender_(std::move(sender)), wake_(wake) {}

LcmBus::~LcmBus() {
  stop();
  close(wake_);
}

Status LcmBus::subscribe(const std::string& channel, Handler handler, int queued) {
  auto subscription = std::make_unique<Subscription>(Subscription{channel, std::move(handler)});
  lcm_subscription_t* made =
      lcm_subscribe(lcm(), channel.c_str(), &LcmBus::dispatch, subscription.get());
  if (!made) return Error{ErrorCode::kIo, "lcm", "cannot subscribe to " + channel};
  lcm_subscription_set_queue_capacity(made, queued);
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
  shutdown(lcm_get_fileno(lcm()), SHUT_RDWR);
  thread_.join();
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
    pollfd files[2] = {{wake_, POLLIN, 0}, {lcm_get_fileno(lcm()), POLLIN, 0}};
    const bool connected = files[1].fd >= 0;
    if (poll(files, 2, connected ? -1 : 0) < 0 && errno != EINTR) return;
    if (files[0].revents) return;
    if (connected && !files[1].revents) continue;
    if (lcm_handle(lcm()) == 0) {  // one message; reconnects where that can be done
      failing = false;
      continue;
    }
    if (!failing) spdlog::error("LCM {}: receiving failed; will try again", url());
    failing = true;
    if (woken_within(kRetryMs)) return;
  }
}

}  // namespace anchord
