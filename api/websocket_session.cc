#include "api/websocket_session.h"

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <string>
#include <utility>

namespace anchord {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;
using net::ip::tcp;

namespace {

constexpr std::size_t kHeardBytes = 64 * 1024;  // of one message of a client

/// One WebSocket. At most one read, one write and one timer are under way, all on its strand.
class WebSocketSession : public HttpSession, public std::enable_shared_from_this<WebSocketSession> {
  /// Nothing thrown leaves: the connection ends, the server goes on.
  template <typename Step>
  void safely(Step step) noexcept {
    if (closed_) return;
    try {
      step();
    } catch (...) {
      ++core_.counters.failures;
      close();
    }
  }
  template <typename Step>
  void on_strand(Step step) {
    net::post(timer_.get_executor(), [self = shared_from_this(), step = std::move(step)]() mutable {
      self->safely([&] { step(); });
    });
  }
  template <typename Step>
  auto then(Step step) {
    return [self = shared_from_this(), step = std::move(step)](
               error_code error, auto&&...) mutable { self->safely([&] { step(error); }); };
  }

 public:
  WebSocketSession(HttpCore& core, tcp::socket socket, UpgradeRequest request,
                   StreamOpening opening)
      : core_(core),
        socket_(std::move(socket)),
        timer_(socket_.get_executor()),
        request_(std::move(request)),
        client_(std::move(opening.client)) {
    // Who takes or says nothing for as long, not even the answer to a ping, is gone.
    socket_.set_option(websocket::stream_base::timeout{core.limits.request_time,
                                                       core.limits.stream_idle_time, true});
    socket_.set_option(websocket::stream_base::decorator(
        [protocol = std::move(opening.protocol)](websocket::response_type& response) {
          if (!protocol.empty()) response.set(beast::http::field::sec_websocket_protocol, protocol);
        }));
    socket_.read_message_max(kHeardBytes);
    ++core_.counters.streams;
  }

  void start() override {
    on_strand([this] {
      socket_.async_accept(request_, then([this](error_code error) {
                             if (error) return close();
                             open_ = true;
                             listen();
                             tell();
                           }));
    });
  }
  void refuse() override { stop(true); }
  void wake() override {
    on_strand([this] { tell(); });
  }
  void stop(bool forced) override {
    on_strand([this, forced] {
      if (forced || !open_) return close();
      say_goodbye({websocket::close_code::going_away, "the daemon ends"});
    });
  }

 private:
  void close() noexcept {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    socket_.next_layer().close(ignored);
    try {
      timer_.cancel();
    } catch (...) {  // then it runs out and finds the session closed
    }
    --core_.counters.streams;
    core_.remove(shared_from_this());
  }

  void say_goodbye(websocket::close_reason reason) {
    if (std::exchange(ending_, true)) return;
    timer_.cancel();
    socket_.async_close(reason, then([this](error_code) { close(); }));
  }

  void listen() {
    socket_.async_read(
        heard_, then([this](error_code error) {
          if (error) return close();
          const auto bytes = heard_.data();
          const Status heard =
              socket_.got_text()
                  ? client_->hear({static_cast<const char*>(bytes.data()), bytes.size()})
                  : Status(invalid("", "messages are text"));
          heard_.consume(heard_.size());
          if (!heard && !ending_) {
            ++core_.counters.streams_refused;
            std::string why = heard.error().text();
            why.resize(std::min<std::size_t>(why.size(), 120));  // of at most 123
            say_goodbye({websocket::close_code::policy_error, why});
          }
          listen();
          tell();
        }));
  }

  /// Says what there is to say, as soon as the last message has gone and its pause is over.
  void tell() {
    if (!open_ || ending_ || telling_) return;
    const auto now = net::steady_timer::clock_type::now();
    if (now < quiet_until_) return wait();
    message_ = client_->next();
    if (!message_) return;
    telling_ = true;
    quiet_until_ = now + client_->pause();
    socket_.binary(message_->binary);
    socket_.async_write(net::buffer(*message_->bytes), then([this](error_code error) {
                          if (error) return close();
                          ++core_.counters.streamed;
                          core_.counters.streamed_bytes += message_->bytes->size();
                          telling_ = false;
                          tell();
                        }));
  }

  void wait() {
    if (std::exchange(waiting_, true)) return;
    timer_.expires_at(quiet_until_);
    timer_.async_wait(then([this](error_code error) {
      waiting_ = false;
      if (!error) tell();
    }));
  }

  HttpCore& core_;
  websocket::stream<tcp::socket> socket_;
  net::steady_timer timer_;
  const UpgradeRequest request_;
  const std::unique_ptr<StreamClient> client_;
  beast::flat_buffer heard_;
  std::optional<StreamClient::Message> message_;  ///< that is going out
  net::steady_timer::time_point quiet_until_;
  bool open_ = false, ending_ = false, closed_ = false, telling_ = false, waiting_ = false;
};

}  // namespace

bool wants_stream(const UpgradeRequest& request) { return websocket::is_upgrade(request); }

std::shared_ptr<HttpSession> make_websocket_session(HttpCore& core, tcp::socket socket,
                                                    UpgradeRequest request, StreamOpening opening) {
  return std::make_shared<WebSocketSession>(core, std::move(socket), std::move(request),
                                            std::move(opening));
}

}  // namespace anchord
