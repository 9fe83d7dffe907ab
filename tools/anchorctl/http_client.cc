#include "tools/anchorctl/http_client.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

namespace anchord {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using std::chrono::milliseconds;

constexpr std::uint64_t kLargestBody = 1ull << 30;
constexpr milliseconds kSlice{50};  ///< how often `stopped` is asked

Error unavailable(const ServerAddress& server, const std::string& why) {
  return {ErrorCode::kUnavailable, "",
          "no answer from the daemon at " + server.text() + " (" + why +
              "): is it the right address (--server ADDR:PORT), and is it well?"};
}

Error nobody(const ServerAddress& server, const std::string& why) {
  return {ErrorCode::kUnavailable, "",
          "no daemon at " + server.text() + " (" + why +
              "): start one with `anchord --config FILE`, or name another with --server ADDR:PORT"};
}

/// One request: the steps follow each other on `io`, which the caller runs.
class Exchange {
 public:
  Exchange(asio::io_context& io, const ServerAddress& server, const HttpCall& request)
      : stream_(io),
        server_(server),
        request_(http::string_to_verb(request.method), request.target, 11, request.body) {
    request_.set(http::field::host, server.text());
    request_.set(http::field::user_agent, "anchorctl");
    request_.set(http::field::accept, "application/json");
    request_.set(http::field::connection, "close");
    if (!server.authorization.empty())
      request_.set(http::field::authorization, server.authorization);
    if (!request.body.empty()) request_.set(http::field::content_type, "application/json");
    request_.prepare_payload();
    parser_.body_limit(kLargestBody);
  }

  void start(const asio::ip::tcp::resolver::results_type& ends, milliseconds patience) {
    stream_.expires_after(patience);  // for all steps together
    stream_.async_connect(ends, [this](beast::error_code error, const auto&) {
      if (error) return end(nobody(server_, error.message()));
      http::async_write(stream_, request_, [this](beast::error_code unsent, std::size_t) {
        if (unsent) return end(unavailable(server_, unsent.message()));
        http::async_read(stream_, buffer_, parser_, [this](beast::error_code unread, std::size_t) {
          if (unread) return end(unavailable(server_, unread.message()));
          end(HttpAnswer{static_cast<int>(parser_.get().result_int()),
                         std::move(parser_.get().body())});
        });
      });
    });
  }

  bool ended() const { return ended_; }
  Result<HttpAnswer> outcome() && { return std::move(outcome_); }

 private:
  void end(Result<HttpAnswer> outcome) {
    outcome_ = std::move(outcome);
    ended_ = true;
  }

  beast::tcp_stream stream_;
  const ServerAddress& server_;
  http::request<http::string_body> request_;
  beast::flat_buffer buffer_;
  http::response_parser<http::string_body> parser_;
  Result<HttpAnswer> outcome_ = unavailable(server_, "given up");
  bool ended_ = false;
};

}  // namespace

std::string ServerAddress::text() const {
  return (host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" + port;
}

Result<ServerAddress> parse_server(std::string text) {
  const std::string given = text;
  const auto wrong = [&] {
    return invalid("--server", "'" + given + "' is no ADDR:PORT, such as 127.0.0.1:7780");
  };
  if (text.rfind("http://", 0) == 0) text.erase(0, 7);
  if (!text.empty() && text.back() == '/') text.pop_back();
  ServerAddress server{text, "7780"};
  const std::size_t bracket = text.rfind(']');
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && (bracket == std::string::npos || bracket < colon)) {
    server = {text.substr(0, colon), text.substr(colon + 1)};
  }
  if (server.host.size() > 2 && server.host.front() == '[' && server.host.back() == ']') {
    server.host = server.host.substr(1, server.host.size() - 2);
  } else if (server.host.find_first_of(":[]/ ") != std::string::npos) {
    return wrong();
  }
  const bool digits = server.port.find_first_not_of("0123456789") == std::string::npos;
  if (server.host.empty() || server.port.empty() || server.port.size() > 5 || !digits ||
      std::stoi(server.port) < 1 || std::stoi(server.port) > 65535) {
    return wrong();
  }
  return server;
}

Result<HttpAnswer> http_exchange(const ServerAddress& server, const HttpCall& request,
                                 milliseconds patience, const std::function<bool()>& stopped) {
  try {
    asio::io_context io;
    beast::error_code error;
    const auto ends = asio::ip::tcp::resolver(io).resolve(server.host, server.port, error);
    if (error) return nobody(server, error.message());
    Exchange exchange(io, server, request);
    exchange.start(ends, patience);
    while (!exchange.ended() && !stopped() && !io.stopped()) io.run_for(kSlice);
    return std::move(exchange).outcome();
  } catch (const std::exception& error) {
    return unavailable(server, error.what());
  }
}

}  // namespace anchord
