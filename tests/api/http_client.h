#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "api/http_server.h"

namespace anchord {

using std::chrono::milliseconds;

/// Nothing here waits this long unless it fails.
inline constexpr int kPatienceMs = 20'000;

struct Answer {
  int status = 0;  ///< 0: the connection ended instead
  std::string head, body;

  bool has(const std::string& line) const { return head.find(line) != std::string::npos; }
  std::string code() const { return nlohmann::json::parse(body)["error"]["code"]; }
};

/// A client that sends bytes as they are.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool connected() const { return connected_; }

  /// False once the server has closed.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// Reads one answer; `to_head`: it has no body.
  Answer receive(bool to_head = false) {
    Answer answer;
    std::size_t end;
    while ((end = received_.find("\r\n\r\n")) == std::string::npos)
      if (!receive_more()) return {};
    answer.head = received_.substr(0, end + 2);
    received_.erase(0, end + 4);
    answer.status = std::stoi(answer.head.substr(9, 3));
    const auto length = answer.head.find("Content-Length: ");
    if (length == std::string::npos || to_head) return answer;
    const std::size_t size = std::stoul(answer.head.substr(length + 16));
    while (received_.size() < size)
      if (!receive_more()) return {};
    answer.body = received_.substr(0, size);
    received_.erase(0, size);
    return answer;
  }

  Answer ask(std::string_view bytes) {
    send(bytes);
    return receive();
  }

  /// Whether the server closes without sending anything more.
  bool ends() { return received_.empty() && !receive_more(); }

 private:
  bool receive_more() {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, kPatienceMs) <= 0) {
      ADD_FAILURE() << "nothing came";
      return false;
    }
    char bytes[4096];
    const ssize_t size = ::recv(socket_, bytes, sizeof bytes, 0);
    if (size <= 0) return false;
    received_.append(bytes, static_cast<std::size_t>(size));
    return true;
  }

  int socket_;
  bool connected_ = false;
  std::string received_;
};

inline std::string get(const std::string& target) {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

inline std::string post(const std::string& target, const std::string& body) {
  return "POST " + target +
         " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// Says what it was asked: method, path, parameters, content type, body.
inline void echo(HttpRequest request, HttpReply reply) {
  std::string text = request.method + " " + request.target.path;
  for (const auto& [name, value] : request.target.parameters) text += " " + name + "=" + value;
  text += " [" + request.content_type + "] " + request.body;
  reply({200, "text/plain", text, {{"X-Test", "yes"}}});
}

inline std::unique_ptr<HttpServer> serve(HttpHandler handler, const HttpLimits& limits = {},
                                         HttpDoor door = {}) {
  auto server = HttpServer::start("127.0.0.1:0", std::move(handler), limits, std::move(door));
  if (!server) {
    ADD_FAILURE() << server.error().text();
    return nullptr;
  }
  return *std::move(server);
}

}  // namespace anchord
