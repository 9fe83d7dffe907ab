#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "core/result.h"

namespace anchord {

struct ServerAddress {
  std::string host;  ///< a name or an address, IPv6 without its brackets
  std::string port;
  std::string authorization = {};  ///< that field's value; empty: none is sent

  /// "127.0.0.1:7780", "[::1]:7780".
  std::string text() const;
};

/// "ADDR:PORT", with or without "http://" before and "/" behind. Without a port: 7780.
Result<ServerAddress> parse_server(std::string text);

struct HttpAnswer {
  int status = 0;
  std::string body;
};

/// What is asked of a server.
struct HttpCall {
  std::string method = "GET";  ///< or POST, DELETE
  std::string target;
  std::string body;  ///< JSON, or empty
};

/// Sends `request` to `server`, over a connection of its own. `stopped` is asked many times a
/// second; once it says true the request is given up. Errors (kUnavailable): nobody listens there,
/// no whole answer came within `patience`, or what came is no HTTP. Throws nothing.
Result<HttpAnswer> http_exchange(const ServerAddress& server, const HttpCall& request,
                                 std::chrono::milliseconds patience,
                                 const std::function<bool()>& stopped);

}  // namespace anchord
