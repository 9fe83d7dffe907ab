#include "api/http_server.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <charconv>
#include <exception>
#include <utility>

#include "api/http_core.h"

namespace anchord {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;
using std::chrono::milliseconds;

namespace {

/// How long to wait when no connection can be accepted, for want of descriptors.
constexpr milliseconds kAcceptPause{100};

struct Address {
  std::string host;
  std::uint16_t port = 0;
};

Result<Address> parse_address(const std::string& address) {
  const auto refused = invalid("http", "`" + address +
                                           "` is no address and port; right would be "
                                           "127.0.0.1:7780 or [::1]:7780");
  const auto colon = address.rfind(':');
  if (colon == std::string::npos) return refused;
  Address parsed{address.substr(0, colon), 0};
  const char* end = address.data() + address.size();
  const auto [rest, error] = std::from_chars(address.data() + colon + 1, end, parsed.port);
  if (error != std::errc() || rest != end) return refused;
  std::string& host = parsed.host;
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  else if (host.find(':') != std::string::npos)
    return refused;
  if (host.empty()) return refused;
  return parsed;
}

Error cannot_listen(const Address& address, const error_code& error) {
  const std::string port = std::to_string(address.port);
  if (error == net::error::address_in_use)
    return {ErrorCode::kIo, "",
            "port " + port + " on " + address.host +
                " is in use by another program; stop that one (`ss -ltnp` names it), or choose "
                "another port with --http ADDR:PORT"};
  return {ErrorCode::kIo, "",
          "cannot listen on port " + port + " of " + address.host + ": " + error.message() +
              "; choose another address with --http ADDR:PORT"};
}

bool all_loopback(const tcp::resolver::results_type& found) {
  return std::all_of(found.begin(), found.end(),
                     [](const auto& entry) { return entry.endpoint().address().is_loopback(); });
}

Error no_token(const Address& address) {
  return invalid("http", "`" + address.host +
                             "` can be reached from other machines, whose programs could read and "
                             "change what is believed: give a token with --token-file FILE, or "
                             "serve on 127.0.0.1:" +
                             std::to_string(address.port));
}

Status listen(HttpCore& core, const Address& address) {
  error_code error;
  tcp::resolver resolver(core.io);
  const auto found = resolver.resolve(address.host, std::to_string(address.port),
                                      tcp::resolver::numeric_service, error);
  if (error) return cannot_listen(address, error);
  if (!core.door.beyond_loopback && !all_loopback(found)) return no_token(address);
  const tcp::endpoint endpoint = *found.begin();
  core.acceptor.open(endpoint.protocol(), error);
  // A port that an ended server's connections still wait on may be taken again.
  if (!error) core.acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) core.acceptor.bind(endpoint, error);
  if (!error) core.acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error) return cannot_listen(address, error);
  return Done{};
}

void run(HttpCore& core) noexcept {
  for (;;) {
    try {
      core.io.run();
      return;
    } catch (...) {  // want of memory: what was begun is lost, the server goes on
      ++core.counters.failures;
    }
  }
}

}  // namespace

void HttpCore::accept() {
  acceptor.async_accept(net::make_strand(io), [this](error_code error, tcp::socket socket) {
    if (stopping || error == net::error::operation_aborted) return;
    if (error) {
      accept_again.expires_after(kAcceptPause);
      accept_again.async_wait([this](error_code cancelled) {
        if (!cancelled) accept();
      });
      return;
    }
    try {
      accepted(std::move(socket));
    } catch (...) {
      ++counters.failures;
    }
    accept();
  });
}

void HttpCore::accepted(tcp::socket socket) {
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  auto session = make_http_session(*this, std::move(socket));
  std::size_t count = 0;
  {
    std::lock_guard lock(mutex);
    if (stopping) return;
    if (sessions.size() >= limits.connections) evict_idle();
    sessions.insert(session);
    count = sessions.size();
    ++counters.connections;
    ++counters.open;
  }
  if (count <= limits.connections) return session->start();
  ++counters.refused;
  // Even telling them takes a connection for a moment: beyond twice the limit nobody is told.
  if (count <= 2 * limits.connections)
    session->refuse();
  else
    session->stop(true);
}

void HttpCore::evict_idle() {
  if (idle.empty()) return;
  const auto oldest = std::move(idle.begin()->second);
  idle.erase(idle.begin());
  sessions.erase(oldest);
  ++counters.evicted;
  oldest->stop(true);
}

std::uint64_t HttpCore::falls_idle(std::shared_ptr<HttpSession> session) {
  std::lock_guard lock(mutex);
  idle.emplace(++idle_number, std::move(session));
  return idle_number;
}

bool HttpCore::wakes(std::uint64_t number) noexcept {
  std::lock_guard lock(mutex);
  return idle.erase(number) > 0;
}

void HttpCore::remove(const std::shared_ptr<HttpSession>& session) noexcept {
  {
    std::lock_guard lock(mutex);
    sessions.erase(session);
  }
  --counters.open;
  removed.notify_all();
}

bool HttpCore::replace(const std::shared_ptr<HttpSession>& session,
                       std::shared_ptr<HttpSession> by) {
  std::lock_guard lock(mutex);
  sessions.erase(session);
  if (!stopping) sessions.insert(std::move(by));
  return !stopping;
}

std::vector<std::shared_ptr<HttpSession>> HttpCore::all_sessions() {
  std::lock_guard lock(mutex);
  return {sessions.begin(), sessions.end()};
}

HttpServer::HttpServer(std::shared_ptr<HttpCore> core) : core_(std::move(core)) {}

HttpServer::~HttpServer() { stop(milliseconds(0)); }

Result<std::unique_ptr<HttpServer>> HttpServer::start(const std::string& address,
                                                      HttpHandler handler, const HttpLimits& limits,
                                                      HttpDoor door, StreamOpener streams) {
  auto parsed = parse_address(address);
  if (!parsed) return parsed.error();
  try {
    std::unique_ptr<HttpServer> server(new HttpServer(std::make_shared<HttpCore>(
        std::move(handler), limits, std::move(door), std::move(streams))));
    HttpCore& core = *server->core_;
    if (auto listening = listen(core, *parsed); !listening) return listening.error();
    server->port_ = core.acceptor.local_endpoint().port();
    core.accept();
    for (int i = 0; i < limits.threads; ++i) server->threads_.emplace_back([&core] { run(core); });
    return server;
  } catch (const std::exception& failure) {
    return Error{ErrorCode::kIo, "",
                 std::string("cannot start the HTTP server: ") + failure.what()};
  }
}

const HttpCounters& HttpServer::counters() const { return core_->counters; }

void HttpServer::wake_streams() {
  HttpCore& core = *core_;
  if (core.counters.streams == 0 || core.waking.exchange(true)) return;
  net::post(core.io, [&core] {
    core.waking = false;
    for (const auto& session : core.all_sessions()) session->wake();
  });
}

void HttpServer::stop(milliseconds drain) {
  if (threads_.empty()) return;
  HttpCore& core = *core_;
  {
    std::lock_guard lock(core.mutex);
    core.stopping = true;
  }
  net::post(core.acceptor.get_executor(), [&core] {
    error_code ignored;
    core.acceptor.close(ignored);
    core.accept_again.cancel();
  });
  for (const auto& session : core.all_sessions()) session->stop(false);
  const auto all_gone = [&core] { return core.sessions.empty(); };
  {
    std::unique_lock lock(core.mutex);
    core.removed.wait_for(lock, drain, all_gone);
  }
  for (const auto& session : core.all_sessions()) session->stop(true);
  {
    std::unique_lock lock(core.mutex);
    core.removed.wait(lock, all_gone);
  }
  core.work.reset();
  for (auto& thread : threads_) thread.join();
  threads_.clear();
  core.handler = nullptr;
  core.streams = nullptr;
}

}  // namespace anchord
