#pragma once

#include <lcm/lcm.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/result.h"

namespace anchord {

/// The URL that LcmBus::open() uses for `requested`: for an empty one the environment's
/// LCM_DEFAULT_URL, else LCM's own default with ttl 0; and for udpm:// without recv_buf_size the
/// largest buffer that the kernel gives, at most 4 MiB, for a burst of large frames.
std::string effective_lcm_url(const std::string& requested);

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
  /// `channel` is a regular expression, as in LCM.
  Status subscribe(const std::string& channel, Handler handler);

  /// Starts receiving, once.
  void start();

  /// Ends receiving for good and returns when no handler runs any more. Not from a handler.
  void stop();

  /// Sends bytes. Safe from any thread.
  Status publish(const std::string& channel, std::span<const std::uint8_t> bytes);

  /// The URL in use.
  const std::string& url() const { return url_; }

 private:
  struct Subscription {
    std::string channel;
    Handler handler;
  };
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };

  LcmBus(std::string url, lcm_t* lcm, int wake);
  static void dispatch(const lcm_recv_buf_t* received, const char* channel, void* subscription);
  void receive();
  bool woken_within(int timeout_ms) const;

  std::string url_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;  ///< outlive lcm_, which points there
  std::unique_ptr<lcm_t, Destroy> lcm_;
  std::mutex publishing_;  ///< liblcm's tcpq provider does not lock
  int wake_;               ///< eventfd, readable once the thread shall end
  std::thread thread_;
};

}  // namespace anchord
