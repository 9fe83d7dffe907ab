#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace anchord {

/// Who watches over a WebSocket.
class StreamClientSocket {
  using tcp = boost::asio::ip::tcp;

 public:
  /// `protocols`: those offered, as in the field; empty: none.
  explicit StreamClientSocket(std::uint16_t port, const std::string& target = "/v1/stream",
                              const std::string& protocols = {}) {
    namespace websocket = boost::beast::websocket;
    boost::system::error_code error;
    socket_.next_layer().connect({boost::asio::ip::address_v4::loopback(), port}, error);
    socket_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      if (!protocols.empty())
        request.set(boost::beast::http::field::sec_websocket_protocol, protocols);
    }));
    if (!error) socket_.handshake(response_, "localhost", target, error);
    open_ = !error;
  }

  bool open() const { return open_; }
  /// Of the answer to the handshake.
  int status() const { return static_cast<int>(response_.result_int()); }
  std::string protocol() const {
    return std::string(response_[boost::beast::http::field::sec_websocket_protocol]);
  }

  /// The next message; empty once the server has closed.
  std::string hear() {
    boost::beast::flat_buffer bytes;
    boost::system::error_code error;
    socket_.read(bytes, error);
    if (error) open_ = false;
    return error ? "" : std::string(static_cast<const char*>(bytes.data().data()), bytes.size());
  }
  nlohmann::json hear_json() { return nlohmann::json::parse(hear(), nullptr, false); }
  bool say(const std::string& text) {
    boost::system::error_code error;
    socket_.write(boost::asio::buffer(text), error);
    return !error;
  }
  /// With which code the server has closed.
  int close_code() const { return socket_.reason().code; }
  std::string close_reason() const { return std::string(socket_.reason().reason.c_str()); }

 private:
  boost::asio::io_context io_;
  boost::beast::websocket::stream<tcp::socket> socket_{io_};
  boost::beast::websocket::response_type response_;
  bool open_ = false;
};

}  // namespace anchord
