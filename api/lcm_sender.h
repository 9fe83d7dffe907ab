#pragma once

#include <lcm/lcm.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "core/result.h"

namespace anchord {

/// The URL that is used for `requested`: for an empty one the environment's LCM_DEFAULT_URL, else
/// LCM's own default with ttl 0; and for udpm:// without recv_buf_size the largest buffer that the
/// kernel gives, at most 8 MiB, for a burst of large frames.
std::string effective_lcm_url(const std::string& requested);

/// Why an LCM network cannot be used, and what may help.
Error lcm_network_error(const std::string& url);

/// Publishes on an LCM network and hears nothing of it: liblcm opens the socket that receives, and
/// starts the thread that reads it, only for a subscription or when asked for its file, and neither
/// is asked for here. So nothing that others send can reach this process through it.
class LcmSender {
 public:
  /// Any URL that liblcm takes; see effective_lcm_url(). Refuses a URL that is no such thing and a
  /// network without a route, saying how to add one.
  static Result<std::unique_ptr<LcmSender>> open(const std::string& url);

  LcmSender(const LcmSender&) = delete;
  LcmSender& operator=(const LcmSender&) = delete;

  /// Sends bytes. Safe from any thread.
  Status publish(const std::string& channel, std::span<const std::uint8_t> bytes);

  /// The URL in use.
  const std::string& url() const { return url_; }

 private:
  friend class LcmBus;  // it receives with the same connection
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };

  LcmSender(std::string url, lcm_t* lcm) : url_(std::move(url)), lcm_(lcm) {}

  std::string url_;
  std::unique_ptr<lcm_t, Destroy> lcm_;
  std::mutex publishing_;  ///< liblcm's tcpq provider does not lock
};

}  // namespace anchord
