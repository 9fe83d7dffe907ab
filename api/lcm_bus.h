#pragma once

#include <lcm/lcm.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "api/lcm_sender.h"
#include "core/result.h"

namespace anchord {

/// A connection to an LCM network, and the thread that receives from it. LCM has no notion of who
/// sends: every byte that comes in is untrusted.
class LcmBus {
 public:
  /// Called on the bus' own thread, one message at a time. May publish. An exception is logged and
  /// goes no further.
  using Handler = std::function<void(std::span<const std::uint8_t>)>;

  /// Connects to any URL that liblcm takes; see effective_lcm_url(). Refuses a URL that is no such
  /// thing and a network that cannot be reached, saying how to add a multicast route.
  static Result<std::unique_ptr<LcmBus>> open(const std::string& url);

  /// Stops receiving.
  ~LcmBus();
  LcmBus(const LcmBus&) = delete;
  LcmBus& operator=(const LcmBus&) = delete;

  /// Hands every message of a channel to `handler`, once start() is called. Only before start().
  /// `channel` is a regular expression, as in LCM. While a handler is busy `queued` messages wait;
  /// liblcm drops more, and tells nobody.
  Status subscribe(const std::string& channel, Handler handler, int queued = kQueued);

  /// Starts receiving, once.
  void start();

  /// Ends receiving for good and returns when no handler runs any more. Not from a handler.
  void stop();

  /// Sends bytes. Safe from any thread.
  Status publish(const std::string& channel, std::span<const std::uint8_t> bytes) {
    return sender_->publish(channel, bytes);
  }

  /// The URL in use.
  const std::string& url() const { return sender_->url(); }

 private:
  struct Subscription {
    std::string channel;
    Handler handler;
  };
  static constexpr int kQueued = 500;  // LCM's default is 30

  LcmBus(std::unique_ptr<LcmSender> sender, int wake);
  lcm_t* lcm() const { return sender_->lcm_.get(); }
  static void dispatch(const lcm_recv_buf_t* received, const char* channel, void* subscription);
  void receive();
  bool woken_within(int timeout_ms) const;

  std::vector<std::unique_ptr<Subscription>> subscriptions_;  ///< outlive what points there:
  std::unique_ptr<LcmSender> sender_;
  int wake_;  ///< eventfd, readable once the thread shall end
  std::thread thread_;
};

}  // namespace anchord
