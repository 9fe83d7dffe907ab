#include "bench/http_client.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace anchord::bench {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

}  // namespace

struct HttpClient::Connection {
  asio::io_context context;
  asio::ip::tcp::socket socket{context};
  boost::beast::flat_buffer buffer;
  std::string answer;

  int ask(http::verb verb, const std::string& target, std::string body) {
    http::request<http::string_body> request(verb, target, 11, std::move(body));
    request.set(http::field::host, "localhost");
    if (verb == http::verb::post) request.set(http::field::content_type, "application/json");
    request.prepare_payload();
    boost::system::error_code error;
    http::response<http::string_body> response;
    http::write(socket, request, error);
    if (!error) http::read(socket, buffer, response, error);
    if (error) {
      std::fprintf(stderr, "%s: %s\n", target.c_str(), error.message().c_str());
      std::exit(1);
    }
    answer = std::move(response.body());
    return static_cast<int>(response.result_int());
  }
};

HttpClient::HttpClient(std::uint16_t port) : connection_(std::make_unique<Connection>()) {
  boost::system::error_code error;
  connection_->socket.connect({asio::ip::address_v4::loopback(), port}, error);
  if (!error) connection_->socket.set_option(asio::ip::tcp::no_delay(true), error);
  if (error) {
    std::fprintf(stderr, "port %u: %s\n", static_cast<unsigned>(port), error.message().c_str());
    std::exit(1);
  }
}

HttpClient::~HttpClient() = default;

int HttpClient::get(const std::string& target) {
  return connection_->ask(http::verb::get, target, {});
}

int HttpClient::post(const std::string& target, const std::string& json) {
  return connection_->ask(http::verb::post, target, json);
}

const std::string& HttpClient::body() const { return connection_->answer; }

std::uint16_t free_port() {
  asio::io_context context;
  const asio::ip::tcp::acceptor probe(context, {asio::ip::address_v4::loopback(), 0});
  return probe.local_endpoint().port();
}

}  // namespace anchord::bench
