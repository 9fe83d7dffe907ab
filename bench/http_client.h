#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace anchord::bench {

/// A client over one connection that is kept alive. A connection that breaks ends the program.
class HttpClient {
 public:
  explicit HttpClient(std::uint16_t port);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// The status of the answer, which has been read whole.
  int get(const std::string& target);
  int post(const std::string& target, const std::string& json);
  /// Of the latest answer.
  const std::string& body() const;

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

/// A port of this machine that nobody listened on a moment ago.
std::uint16_t free_port();

}  // namespace anchord::bench
