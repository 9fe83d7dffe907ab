#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "api/http_checks.h"
#include "api/http_core.h"
#include "api/websocket_session.h"

namespace anchord {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using net::ip::tcp;
using std::chrono::milliseconds;

namespace {

constexpr std::size_t kReadBytes = 16 * 1024;

constexpr char kRetryAfter_s[] = "1";

/// One connection: read a request, hand it over, write the answer, and again. At most one read, one
/// write and one timer are under way; all of it runs on the socket's strand.
class Session : public HttpSession, public std::enable_shared_from_this<Session> {
 public:
  Session(HttpCore& core, tcp::socket socket)
      : core_(core), socket_(std::move(socket)), timer_(socket_.get_executor()) {}

  void start() override {
    net::post(socket_.get_executor(), [self = shared_from_this()] {
      if (self->state_ == State::kClosed) return;  // stopped before it began
      self->safely([&] { self->next_request(); });
    });
  }
  void refuse() override {
    net::post(socket_.get_executor(), [self = shared_from_this()] {
      if (self->state_ == State::kClosed) return;
      self->safely([&] {
        self->parser_.emplace();
        self->respond(http_error(503, "too_many_connections",
                                 "the server has as many connections as it may; try again later"),
                      false);
      });
    });
  }
  void stop(bool forced) override {
    net::post(socket_.get_executor(), [self = shared_from_this(), forced] {
      if (forced || self->state_ == State::kIdle) self->close();
    });
  }
  /// From any thread of the server: the handler's answer.
  void deliver(HttpResponse response) {
    net::dispatch(socket_.get_executor(),
                  [self = shared_from_this(), answer = std::move(response)]() mutable {
                    if (self->state_ != State::kHandling) return;
                    self->safely([&] { self->respond(std::move(answer), self->may_keep_alive()); });
                  });
  }

 private:
  enum class State { kIdle, kReading, kHandling, kWriting, kLingering, kClosed };

  /// Nothing thrown here leaves: the connection ends, the server goes on.
  template <typename Step>
  void safely(Step step) noexcept {
    try {
      step();
    } catch (...) {
      ++core_.counters.failures;
      close();
    }
  }

  void close() noexcept {
    if (std::exchange(state_, State::kClosed) == State::kClosed) return;
    core_.wakes(idle_number_);
    error_code ignored;
    socket_.close(ignored);
    try {
      timer_.cancel();
    } catch (...) {  // then it runs out and finds the session closed
    }
    core_.remove(shared_from_this());
  }

  bool may_keep_alive() const { return parser_->keep_alive() && !core_.stopping; }

  void set_timer(milliseconds time) {
    timer_.expires_after(time);
    timer_.async_wait([self = shared_from_this()](error_code error) {
      // It may have been set anew after it ran out and before this was called.
      if (error || self->timer_.expiry() > net::steady_timer::clock_type::now()) return;
      self->safely([&] { self->on_timer(); });
    });
  }

  void on_timer() {
    switch (state_) {
      case State::kReading:
        ++core_.counters.request_timeouts;
        socket_.cancel();  // on_read() then sees that nobody waits for it
        return respond(http_error(408, "timeout",
                                  "the request was not complete within " +
                                      std::to_string(core_.limits.request_time.count()) + " ms"),
                       false);
      case State::kIdle:
        ++core_.counters.idle_closed;
        return close();
      case State::kWriting:
        ++core_.counters.write_timeouts;
        return close();
      case State::kLingering:
        return close();
      case State::kHandling:
      case State::kClosed:
        return;
    }
  }

  void next_request() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(core_.limits.header_bytes));
    parser_->body_limit(core_.limits.body_bytes);
    header_bytes_ = 0;
    header_checked_ = false;
    if (buffer_.size() > 0) {
      begin_reading();
      return parse();
    }
    if (core_.stopping) return close();
    state_ = State::kIdle;
    set_timer(core_.limits.idle_time);
    idle_number_ = core_.falls_idle(shared_from_this());
    read_more();
  }

  void begin_reading() {
    state_ = State::kReading;
    set_timer(core_.limits.request_time);
  }

  void read_more() {
    socket_.async_read_some(buffer_.prepare(kReadBytes),
                            [self = shared_from_this()](error_code error, std::size_t size) {
                              self->safely([&] { self->on_read(error, size); });
                            });
  }

  void on_read(error_code error, std::size_t size) {
    if (state_ != State::kIdle && state_ != State::kReading) return;
    if (error == net::error::eof && state_ == State::kReading)
      return respond(refusal_of(http::error::partial_message, core_.limits), false);
    if (error) return close();
    if (state_ == State::kIdle) {
      if (!core_.wakes(idle_number_)) return close();
      begin_reading();
    }
    buffer_.commit(size);
    parse();
  }

  void parse() {
    for (;;) {
      if (buffer_.size() == 0) return read_more();
      const bool in_header = !parser_->is_header_done();
      error_code error;
      const std::size_t used = parser_->put(buffer_.data(), error);
      buffer_.consume(used);
      // The parser's own limit starts anew with every piece that it takes.
      if (in_header) header_bytes_ += used;
      const bool need_more = error == http::error::need_more;
      if (header_bytes_ == 0 && need_more && begins_with_long_target(buffered(), core_.limits))
        return respond(target_too_long(core_.limits), false);
      if ((in_header ? header_bytes_ : 0) + (need_more ? buffer_.size() : 0) >
          core_.limits.header_bytes)
        return respond(refusal_of(http::error::header_limit, core_.limits), false);
      if (need_more) return read_more();
      if (error) return respond(refusal_of(error, core_.limits), false);
      if (parser_->is_header_done() && !std::exchange(header_checked_, true)) {
        if (auto refused = check_header(parser_->get().base(), core_))
          return respond(*std::move(refused), false);
        parser_->eager(true);
        if (!parser_->is_done() && expects_continue() && buffer_.size() == 0)
          return send_continue();
      }
      if (parser_->is_done()) return handle();
    }
  }

  std::string_view buffered() const {
    return {static_cast<const char*>(buffer_.data().data()), buffer_.size()};
  }

  bool expects_continue() const {
    const auto& request = parser_->get();
    return request.version() >= 11 && request.count(http::field::expect) > 0;
  }

  void send_continue() {
    static constexpr char kContinue[] = "HTTP/1.1 100 Continue\r\n\r\n";
    net::async_write(socket_, net::buffer(kContinue, sizeof kContinue - 1),
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (self->state_ != State::kReading) return;
                       self->safely([&] { error ? self->close() : self->read_more(); });
                     });
  }

  void handle();
  void upgrade(const HttpTarget& target);

  /// Writes the answer; then comes the next request, or the end.
  void respond(HttpResponse response, bool keep_alive) {
    state_ = State::kWriting;
    set_timer(core_.limits.write_time);
    const auto& request = parser_->get();
    if (response.status < 200 || response.status > 599) response.status = 500;
    ++core_.counters.responses[response.status / 100];
    const bool without_body = response.status == 204 || response.status == 304;
    response_.emplace();
    response_->version(request.version() == 10 ? 10 : 11);
    response_->result(static_cast<unsigned>(response.status));
    if (!without_body) {
      response_->set(http::field::content_type, response.content_type);
      response_->body() = std::move(response.body);
    }
    for (const auto& [name, value] : response.headers) response_->set(name, value);
    if (response.status == 503) response_->set(http::field::retry_after, kRetryAfter_s);
    response_->keep_alive(keep_alive);
    response_->prepare_payload();
    serializer_.emplace(*response_);
    auto written = [self = shared_from_this(), keep_alive](error_code error, std::size_t) {
      if (self->state_ != State::kWriting) return;
      self->safely([&] { error ? self->close() : self->on_written(keep_alive); });
    };
    if (request.method() == http::verb::head)
      http::async_write_header(socket_, *serializer_, std::move(written));
    else
      http::async_write(socket_, *serializer_, std::move(written));
  }

  void on_written(bool keep_alive) {
    serializer_.reset();
    response_.reset();
    if (keep_alive) return next_request();
    // Closing with bytes unread would reset the connection, and the answer with it.
    error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
    state_ = State::kLingering;
    set_timer(core_.limits.linger_time);
    buffer_.clear();
    discard();
  }

  void discard() {
    socket_.async_read_some(buffer_.prepare(kReadBytes),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              self->safely([&] { error ? self->close() : self->discard(); });
                            });
  }

  HttpCore& core_;
  tcp::socket socket_;
  net::steady_timer timer_;
  State state_ = State::kIdle;
  std::uint64_t idle_number_ = 0;  ///< while it is idle: its place among those that are
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::size_t header_bytes_ = 0;
  bool header_checked_ = false;
  std::optional<http::response<http::string_body>> response_;
  std::optional<http::response_serializer<http::string_body>> serializer_;
};

/// A request's one answer; shared by the copies of its HttpReply.
class Pending {
 public:
  Pending(std::shared_ptr<HttpCore> core, std::weak_ptr<Session> session)
      : core_(std::move(core)), session_(std::move(session)) {}
  ~Pending() {
    if (answered_) return;
    ++core_->counters.failures;
    answer(http_error(500, "internal", "the request was dropped without an answer"));
  }
  Pending(const Pending&) = delete;
  Pending& operator=(const Pending&) = delete;

  void answer(HttpResponse response) noexcept {
    if (answered_.exchange(true)) return;
    try {
      // Only a weak reference is queued: after the server's end nobody runs this.
      net::post(core_->io, [session = session_, answer = std::move(response)]() mutable {
        if (auto alive = session.lock()) alive->deliver(std::move(answer));
      });
    } catch (...) {  // no memory: the connection ends with the server
      ++core_->counters.failures;
    }
  }

 private:
  std::shared_ptr<HttpCore> core_;
  std::weak_ptr<Session> session_;
  std::atomic<bool> answered_{false};
};

void Session::handle() {
  state_ = State::kHandling;
  timer_.cancel();
  ++core_.counters.requests;
  auto& message = parser_->get();
  if (message.method() == http::verb::options)
    return respond({204, "", "", {{"Allow", "GET, HEAD, POST, OPTIONS"}}}, may_keep_alive());
  auto target = parse_target({message.target().data(), message.target().size()});
  if (!target) return respond(http_error(target.error()), may_keep_alive());
  if (core_.streams && wants_stream(message)) return upgrade(*target);
  const auto method =
      message.method() == http::verb::head ? beast::string_view("GET") : message.method_string();
  const auto content_type = message[http::field::content_type];
  HttpRequest request{std::string(method), *std::move(target), std::string(content_type),
                      std::move(message.body()), std::string(message[http::field::if_none_match])};
  auto pending = std::make_shared<Pending>(core_.shared_from_this(), weak_from_this());
  try {
    core_.handler(std::move(request),
                  [pending](HttpResponse response) { pending->answer(std::move(response)); });
  } catch (...) {
    ++core_.counters.failures;
    pending->answer(http_error(500, "internal", "the request could not be handled"));
  }
}

/// The connection goes on as a WebSocket, or the request is refused as any other.
void Session::upgrade(const HttpTarget& target) {
  auto& message = parser_->get();
  const auto refuse = [&](HttpResponse why) { respond(std::move(why), false); };
  if (buffer_.size() > 0)
    return refuse(http_error(400, "malformed", "a WebSocket's frames come after the handshake"));
  if (core_.counters.streams >= core_.limits.streams)
    return refuse(http_error(503, "too_many_streams",
                             "there are as many streams as there may be; try again later"));
  const auto field = message[http::field::sec_websocket_protocol];
  auto opening = core_.streams(target, offered_protocols({field.data(), field.size()}));
  if (!opening) return refuse(http_error(opening.error()));
  ++core_.counters.responses[1];
  state_ = State::kClosed;
  const auto stream =
      make_websocket_session(core_, std::move(socket_), parser_->release(), *std::move(opening));
  core_.replace(shared_from_this(), stream) ? stream->start() : stream->stop(true);
}

}  // namespace

std::shared_ptr<HttpSession> make_http_session(HttpCore& core, tcp::socket socket) {
  return std::make_shared<Session>(core, std::move(socket));
}

}  // namespace anchord
