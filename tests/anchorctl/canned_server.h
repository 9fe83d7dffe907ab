#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace anchord {

/// A TCP server on a port of its own at 127.0.0.1 that answers requests with prepared bytes, one
/// connection after the other.
class CannedServer {
 public:
  /// `answers`: for each target the whole response; those to other methods than GET under
  /// "POST /v1/events". What is not in it is answered with 404.
  explicit CannedServer(std::map<std::string, std::string> answers);
  ~CannedServer();
  CannedServer(const CannedServer&) = delete;
  CannedServer& operator=(const CannedServer&) = delete;

  /// "127.0.0.1:PORT".
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  /// The targets that were asked for, with the method unless that is GET, and with the body if
  /// there is one: "POST /v1/events {..}".
  std::vector<std::string> asked() const;

 private:
  void serve();

  const std::map<std::string, std::string> answers_;
  mutable std::mutex mutex_;
  std::vector<std::string> asked_;  // guarded by mutex_
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

/// A response with its length.
std::string http_response(const std::string& status, const std::string& body);

}  // namespace anchord
