#include "tests/anchorctl/canned_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace anchord {

CannedServer::CannedServer(std::map<std::string, std::string> answers)
    : answers_(std::move(answers)), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, generic, size) != 0 || ::listen(listener_, 8) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    throw std::runtime_error("no port on the loopback");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

CannedServer::~CannedServer() {
  ::shutdown(listener_, SHUT_RDWR);  // accept() returns
  thread_.join();
  ::close(listener_);
}

std::vector<std::string> CannedServer::asked() const {
  std::lock_guard lock(mutex_);
  return asked_;
}

void CannedServer::serve() {
  for (int client; (client = ::accept(listener_, nullptr, nullptr)) >= 0; ::close(client)) {
    std::string request;
    char bytes[4096];
    while (request.find("\r\n\r\n") == std::string::npos) {
      const ssize_t size = ::recv(client, bytes, sizeof bytes, 0);
      if (size <= 0) break;
      request.append(bytes, static_cast<std::size_t>(size));
    }
    const std::size_t head = request.find("\r\n\r\n");
    if (head == std::string::npos) continue;
    const std::size_t length = request.find("Content-Length: ");
    const std::size_t size = length < head ? std::stoul(request.substr(length + 16)) : 0;
    while (request.size() < head + 4 + size) {
      const ssize_t more = ::recv(client, bytes, sizeof bytes, 0);
      if (more <= 0) break;
      request.append(bytes, static_cast<std::size_t>(more));
    }
    std::string target = request.substr(0, request.find(' ', request.find(' ') + 1));
    if (target.rfind("GET ", 0) == 0) target.erase(0, 4);
    {
      std::lock_guard lock(mutex_);
      const std::string body = request.substr(head + 4);
      asked_.push_back(target + (body.empty() ? "" : " " + body));
    }
    const auto found = answers_.find(target);
    const std::string answer =
        found != answers_.end() ? found->second : http_response("404 Not Found", "{}");
    ::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
  }
}

std::string http_response(const std::string& status, const std::string& body) {
  return "HTTP/1.1 " + status +
         "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\n\r\n" + body;
}

}  // namespace anchord
