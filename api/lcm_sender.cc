#include "api/lcm_sender.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace anchord {
namespace {

constexpr const char* kProviders[] = {"udpm://", "tcpq://", "memq://", "file://"};

constexpr char kDefaultUrl[] = "udpm://239.255.76.67:7667?ttl=0";
constexpr long kReceiveBufferBytes = 8L << 20;

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

Error lcm_network_error(const std::string& url) {
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

Result<std::unique_ptr<LcmSender>> LcmSender::open(const std::string& requested) {
  std::string url = effective_lcm_url(requested);
  lcm_t* lcm = lcm_create(url.c_str());
  if (!lcm) return lcm_network_error(url);
  return std::unique_ptr<LcmSender>(new LcmSender(std::move(url), lcm));
}

Status LcmSender::publish(const std::string& channel, std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(publishing_);
  const auto size = static_cast<unsigned>(bytes.size());
  if (lcm_publish(lcm_.get(), channel.c_str(), bytes.data(), size) != 0) {
    return Error{ErrorCode::kIo, "lcm", "cannot publish on " + channel};
  }
  return Done{};
}

}  // namespace anchord
