#pragma once

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <unordered_set>
#include <vector>

#include "api/http_server.h"
#include "api/stream.h"

namespace anchord {

/// The inside of HttpServer: what its connections share. For http_server.cc and http_session.cc.

/// One connection. It is closed by removing itself from its core.
class HttpSession {
 public:
  virtual ~HttpSession() = default;
  /// Reads requests and answers them.
  virtual void start() = 0;
  /// Tells that there are too many connections, and closes.
  virtual void refuse() = 0;
  /// From any thread: closes if no request has begun, or at once if it is forced.
  virtual void stop(bool forced) = 0;
  /// From any thread: there may be something new to tell a stream.
  virtual void wake() {}
};

/// A reply that is still out keeps it alive beyond the server, so that it can always be given; it
/// reaches no connection then.
struct HttpCore : std::enable_shared_from_this<HttpCore> {
  using tcp = boost::asio::ip::tcp;

  HttpCore(HttpHandler the_handler, const HttpLimits& the_limits, HttpDoor the_door,
           StreamOpener the_streams)
      : handler(std::move(the_handler)),
        limits(the_limits),
        door(std::move(the_door)),
        streams(std::move(the_streams)) {}

  void accept();
  void accepted(tcp::socket socket);
  void remove(const std::shared_ptr<HttpSession>& session) noexcept;
  /// One session goes on with another's connection. False: the server ends.
  bool replace(const std::shared_ptr<HttpSession>& session, std::shared_ptr<HttpSession> by);
  std::vector<std::shared_ptr<HttpSession>> all_sessions();
  /// Closes the one that has been idle for longest, if any is. The caller holds the mutex.
  void evict_idle();
  /// From now on the session may be evicted; the number is for wakes().
  std::uint64_t falls_idle(std::shared_ptr<HttpSession> session);
  /// No longer. False: it has been, and must close without reading what came.
  bool wakes(std::uint64_t number) noexcept;

  boost::asio::io_context io;  // first: destroyed after everything that runs on it
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work{io.get_executor()};
  HttpHandler handler;
  const HttpLimits limits;
  const HttpDoor door;
  StreamOpener streams;
  HttpCounters counters;
  tcp::acceptor acceptor{boost::asio::make_strand(io)};
  boost::asio::steady_timer accept_again{acceptor.get_executor()};
  std::atomic<bool> stopping{false}, waking{false};
  std::mutex mutex;
  std::condition_variable removed;
  std::unordered_set<std::shared_ptr<HttpSession>> sessions;   // guarded by mutex
  std::map<std::uint64_t, std::shared_ptr<HttpSession>> idle;  // in their order; by mutex
  std::uint64_t idle_number = 0;                               // by mutex
};

std::shared_ptr<HttpSession> make_http_session(HttpCore& core, HttpCore::tcp::socket socket);

}  // namespace anchord
