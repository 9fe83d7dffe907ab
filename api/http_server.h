#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "api/http_door.h"
#include "api/http_message.h"
#include "api/stream.h"
#include "core/result.h"

namespace anchord {

struct HttpCore;

/// What clients may take of the server.
struct HttpLimits {
  std::size_t header_bytes = 16 * 1024;            ///< request line and fields; more: 431
  std::size_t target_bytes = 8 * 1024;             ///< path and parameters; more: 414
  std::size_t body_bytes = 8 * 1024 * 1024;        ///< plain or chunked; more: 413
  std::size_t connections = 256;                   ///< open ones; see HttpServer
  std::chrono::milliseconds request_time{10'000};  ///< first byte to last; longer: 408
  std::chrono::milliseconds idle_time{60'000};     ///< between requests; longer: closed
  std::chrono::milliseconds write_time{10'000};    ///< to take an answer; longer: closed
  std::chrono::milliseconds linger_time{1'000};    ///< to read the answer before the close
  std::size_t streams = 64;                        ///< WebSockets among the connections; more: 503
  std::chrono::milliseconds stream_idle_time{30'000};  ///< without a sign of life: closed
  int threads = 2;
};

/// What has happened so far; read at any time.
struct HttpCounters {
  std::atomic<std::uint64_t> connections{0};       ///< accepted
  std::atomic<std::uint64_t> open{0};              ///< now
  std::atomic<std::uint64_t> refused{0};           ///< connections over the limit
  std::atomic<std::uint64_t> evicted{0};           ///< idle ones that made room for new ones
  std::atomic<std::uint64_t> unauthorized{0};      ///< answered with 401
  std::atomic<std::uint64_t> foreign{0};           ///< other refusals of the door (403, 421)
  std::atomic<std::uint64_t> requests{0};          ///< read whole
  std::atomic<std::uint64_t> responses[6]{};       ///< by class of status; [4]: 4xx
  std::atomic<std::uint64_t> request_timeouts{0};  ///< answered with 408
  std::atomic<std::uint64_t> write_timeouts{0};    ///< clients that did not take their answer
  std::atomic<std::uint64_t> idle_closed{0};
  std::atomic<std::uint64_t> streams{0};          ///< WebSockets that are open now
  std::atomic<std::uint64_t> streams_refused{0};  ///< ended for what their clients said
  std::atomic<std::uint64_t> streamed{0};         ///< messages that went out on them
  std::atomic<std::uint64_t> streamed_bytes{0};   ///< of these, without frames and headers
  std::atomic<std::uint64_t> failures{0};         ///< exceptions, and requests that nobody answered
};

/// An HTTP/1.1 server with keep-alive and pipelining; a connection's requests are answered one
/// after the other. Reads Content-Length and chunked bodies, honours `Expect: 100-continue`,
/// answers OPTIONS by itself, and refuses by itself what is no well-formed request, is over a limit
/// or is not let in by the door, before it reads a body; all else, unknown methods and paths
/// included, is the handler's. A new connection over their limit takes the place of the one that
/// has been idle for longest; it gets 503 where none is idle. What is answered with 503 bears
/// Retry-After. Who asks for a WebSocket becomes a stream's client, if the opener lets him. It
/// knows no TLS.
class HttpServer {
 public:
  /// Listens on `address`, "ADDR:PORT" (`127.0.0.1:7780`, `[::1]:7780`, `localhost:0`; port 0: any
  /// free one) and serves on threads of its own. Errors: kInvalid: the address, or it (for a name:
  /// any that it stands for) is no loopback address and the door does not allow that; kIo: the port
  /// is in use, or the machine refuses.
  static Result<std::unique_ptr<HttpServer>> start(const std::string& address, HttpHandler handler,
                                                   const HttpLimits& limits = {},
                                                   HttpDoor door = {}, StreamOpener streams = {});
  /// stop() without waiting.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::uint16_t port() const { return port_; }
  const HttpCounters& counters() const;

  /// There may be something new to tell the streams' clients. Cheap, from any thread.
  void wake_streams();

  /// Stops listening, closes idle connections, lets requests that have begun finish for at most
  /// `drain`, closes the rest and joins the threads; the handler is not called after that. Not to
  /// be called from the handler. A handler that blocks is waited for.
  void stop(std::chrono::milliseconds drain);

 private:
  explicit HttpServer(std::shared_ptr<HttpCore> core);
  std::shared_ptr<HttpCore> core_;
  std::vector<std::thread> threads_;
  std::uint16_t port_ = 0;
};

}  // namespace anchord
