#include "api/http_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

namespace anchord {
namespace {

using std::chrono::milliseconds;

/// Nothing here waits this long unless it fails.
constexpr int kPatienceMs = 20'000;

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

std::string get(const std::string& target) {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

std::string post(const std::string& target, const std::string& body) {
  return "POST " + target +
         " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// Says what it was asked: method, path, parameters, content type, body.
void echo(HttpRequest request, HttpReply reply) {
  std::string text = request.method + " " + request.target.path;
  for (const auto& [name, value] : request.target.parameters) text += " " + name + "=" + value;
  text += " [" + request.content_type + "] " + request.body;
  reply({200, "text/plain", text, {{"X-Test", "yes"}}});
}

std::unique_ptr<HttpServer> serve(HttpHandler handler, const HttpLimits& limits = {}) {
  auto server = HttpServer::start("127.0.0.1:0", std::move(handler), limits);
  if (!server) {
    ADD_FAILURE() << server.error().text();
    return nullptr;
  }
  return *std::move(server);
}

/// Replies kept for later, as a writer thread would.
class Later {
 public:
  HttpHandler handler() {
    return [this](HttpRequest, HttpReply reply) {
      std::lock_guard lock(mutex_);
      replies_.push_back(std::move(reply));
      came_.notify_all();
    };
  }
  HttpReply take() {
    std::unique_lock lock(mutex_);
    if (!came_.wait_for(lock, milliseconds(kPatienceMs), [&] { return !replies_.empty(); })) {
      ADD_FAILURE() << "no request came";
      return [](HttpResponse) {};
    }
    auto reply = std::move(replies_.back());
    replies_.pop_back();
    return reply;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<HttpReply> replies_;
};

TEST(HttpServer, AnswersOnOneConnectionAgainAndAgain) {
  auto server = serve(echo);
  Client client(server->port());
  for (int i = 0; i < 3; ++i) {
    const auto answer = client.ask(get("/v1/where?class=cup&color=light+blue"));
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, "GET /v1/where class=cup color=light blue [] ");
    EXPECT_TRUE(answer.has("Content-Type: text/plain\r\n"));
    EXPECT_TRUE(answer.has("X-Test: yes\r\n"));
    EXPECT_FALSE(answer.has("Connection: close"));
    EXPECT_EQ(client.ask(post("/v1/detections", "{}")).body,
              "POST /v1/detections [application/json] {}");
  }
  EXPECT_EQ(server->counters().connections, 1u);
  EXPECT_EQ(server->counters().requests, 6u);
  EXPECT_EQ(server->counters().responses[2], 6u);
}

TEST(HttpServer, ReadsByteByByte) {
  auto server = serve(echo);
  Client client(server->port());
  for (int i = 0; i < 2; ++i) {
    for (const char byte : post("/a?b=c", "hello")) ASSERT_TRUE(client.send({&byte, 1}));
    EXPECT_EQ(client.receive().body, "POST /a b=c [application/json] hello");
  }
}

TEST(HttpServer, AnswersPipelinedRequestsInTheirOrder) {
  // The first answer comes from another thread and later than the second could.
  std::vector<std::thread> threads;
  {
    auto server = serve([&](HttpRequest request, HttpReply reply) {
      if (request.target.path != "/slow") return echo(std::move(request), std::move(reply));
      threads.emplace_back([reply = std::move(reply)] {
        std::this_thread::sleep_for(milliseconds(20));
        reply({200, "text/plain", "slow", {}});
      });
    });
    Client client(server->port());
    client.send(get("/slow") + post("/b", "body") + get("/c"));
    EXPECT_EQ(client.receive().body, "slow");
    EXPECT_EQ(client.receive().body, "POST /b [application/json] body");
    EXPECT_EQ(client.receive().body, "GET /c [] ");
  }
  for (auto& thread : threads) thread.join();
}

TEST(HttpServer, ReadsChunkedBodies) {
  auto server = serve(echo);
  Client client(server->port());
  const auto answer = client.ask(
      "POST /a HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"
      "5\r\nhello\r\n7;note=1\r\n, world\r\n0\r\n\r\n" +
      get("/b"));
  EXPECT_EQ(answer.body, "POST /a [] hello, world");
  EXPECT_EQ(client.receive().body, "GET /b [] ");
}

TEST(HttpServer, ClosesWhenAskedToAndForOldClients) {
  auto server = serve(echo);
  Client client(server->port());
  auto answer = client.ask("GET /a HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_TRUE(answer.has("Connection: close\r\n"));
  EXPECT_TRUE(client.ends());
  Client old(server->port());
  answer = old.ask("GET /a HTTP/1.0\r\n\r\n");
  EXPECT_EQ(answer.status, 200);
  EXPECT_TRUE(answer.has("HTTP/1.0 200"));
  EXPECT_TRUE(old.ends());
}

TEST(HttpServer, HeadHasTheFieldsOfGetAndNoBody) {
  auto server = serve(echo);
  Client client(server->port());
  client.send("HEAD /a HTTP/1.1\r\nHost: x\r\n\r\n");
  const auto answer = client.receive(true);
  EXPECT_EQ(answer.status, 200);
  EXPECT_TRUE(answer.has("Content-Length: 10\r\n")) << answer.head;  // of "GET /a [] "
  EXPECT_EQ(client.ask(get("/b")).body, "GET /b [] ");
}

TEST(HttpServer, AnswersOptionsAndLeavesOtherMethodsToTheHandler) {
  auto server = serve(echo);
  Client client(server->port());
  const auto answer = client.ask("OPTIONS * HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_EQ(answer.status, 204);
  EXPECT_TRUE(answer.has("Allow: GET, HEAD, POST, OPTIONS\r\n"));
  EXPECT_EQ(client.ask("BREW /pot HTTP/1.1\r\nHost: x\r\n\r\n").body, "BREW /pot [] ");
}

TEST(HttpServer, AsksForABodyThatTheClientHoldsBack) {
  auto server = serve(echo);
  Client client(server->port());
  client.send("POST /a HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  EXPECT_EQ(client.receive().status, 100);
  EXPECT_EQ(client.ask("hi").body, "POST /a [] hi");
  EXPECT_EQ(
      client.ask("POST /a HTTP/1.1\r\nHost: x\r\nExpect: tea\r\nContent-Length: 2\r\n\r\n").status,
      417);
}

TEST(HttpServer, RefusesABodyOverTheLimitBeforeItIsSent) {
  HttpLimits limits;
  limits.body_bytes = 1000;
  auto server = serve(echo, limits);
  EXPECT_EQ(Client(server->port()).ask(post("/a", std::string(1000, 'x'))).status, 200);
  Client declared(server->port());
  const auto answer = declared.ask(
      "POST /a HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\n"
      "Content-Length: 1001\r\n\r\n");
  EXPECT_EQ(answer.status, 413);
  EXPECT_EQ(answer.code(), "too_large");
  EXPECT_TRUE(declared.ends());
  EXPECT_EQ(Client(server->port())
                .ask("POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999999999999\r\n\r\n")
                .status,
            400);
}

TEST(HttpServer, AClientThatGoesOnSendingStillReadsItsRefusal) {
  HttpLimits limits;
  limits.body_bytes = 1000;
  auto server = serve(echo, limits);
  Client client(server->port());
  client.send("POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 1000000\r\n\r\n");
  client.send(std::string(1'000'000, 'x'));
  EXPECT_EQ(client.receive().status, 413);
}

TEST(HttpServer, RefusesAChunkedBodyOverTheLimit) {
  HttpLimits limits;
  limits.body_bytes = 1000;
  auto server = serve(echo, limits);
  Client client(server->port());
  client.send("POST /a HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (int i = 0; i < 11; ++i) client.send("64\r\n" + std::string(100, 'x') + "\r\n");
  EXPECT_EQ(client.receive().status, 413);
}

TEST(HttpServer, RefusesAHeaderOverTheLimitHoweverItComes) {
  HttpLimits limits;
  limits.header_bytes = 1000;
  auto server = serve(echo, limits);
  const std::string start = "GET /a HTTP/1.1\r\nHost: x\r\n";
  EXPECT_EQ(Client(server->port()).ask(start + "A: " + std::string(2000, 'x')).status, 431);
  EXPECT_EQ(Client(server->port()).ask("GET /" + std::string(2000, 'x')).status, 431);
  // Whole lines one by one, which the parser takes out of the buffer as they come.
  Client client(server->port());
  client.send(start);
  for (int i = 0; i < 30; ++i) {
    client.send("Field-" + std::to_string(i) + ": " + std::string(40, 'x') + "\r\n");
    std::this_thread::sleep_for(milliseconds(1));
  }
  const auto answer = client.receive();
  EXPECT_EQ(answer.status, 431);
  EXPECT_EQ(answer.code(), "header_too_large");
  // The chunks' own lines are held to it as well.
  Client chunks(server->port());
  EXPECT_EQ(chunks
                .ask("POST /a HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n5;a=" +
                     std::string(2000, 'x'))
                .status,
            431);
}

TEST(HttpServer, RefusesWhatIsNoRequest) {
  auto server = serve(echo);
  for (const char* broken :
       {"hello\r\n\r\n", "\x16\x03\x01\x02\x01\x01\xfc\x03\x03 a tls hello\r\n\r\n",
        "GET /a HTTP/3.0\r\nHost: x\r\n\r\n", "GET /a\r\n\r\n", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
        "GET /a HTTP/1.1\r\n\r\n", "GET /a HTTP/1.1\r\nHost: x\r\nHost: y\r\n\r\n",
        "GET /a HTTP/1.1\r\nHost: x\r\nbad field: 1\r\n\r\n",
        "POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: -1\r\n\r\n",
        "POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n",
        "POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n",
        "POST /a HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"}) {
    Client client(server->port());
    const auto answer = client.ask(broken);
    EXPECT_EQ(answer.status, 400) << broken;
    EXPECT_EQ(answer.code(), "malformed");
    EXPECT_TRUE(client.ends());
  }
  EXPECT_EQ(server->counters().requests, 0u);
  EXPECT_EQ(Client(server->port())
                .ask("POST /a HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: gzip\r\n\r\n")
                .status,
            501);
  EXPECT_EQ(Client(server->port())
                .ask("POST /a HTTP/1.1\r\nHost: x\r\nContent-Encoding: gzip\r\n"
                     "Content-Length: 1\r\n\r\nx")
                .status,
            415);
}

TEST(HttpServer, RefusesABrokenEscapeAndReadsOn) {
  auto server = serve(echo);
  Client client(server->port());
  const auto answer = client.ask(get("/a?b=%zz"));
  EXPECT_EQ(answer.status, 400);
  EXPECT_EQ(nlohmann::json::parse(answer.body)["error"]["field"], "target");
  EXPECT_EQ(client.ask(get("/a?b=%7a")).body, "GET /a b=z [] ");
}

TEST(HttpServer, GivesUpOnASlowRequest) {
  HttpLimits limits;
  limits.request_time = milliseconds(100);
  limits.linger_time = milliseconds(100);
  auto server = serve(echo, limits);
  const std::string start = "POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 1000000\r\n";
  for (const std::string& sent : {std::string("G"), start, start + "\r\nabc"}) {
    Client client(server->port());
    const auto answer = client.ask(sent);
    EXPECT_EQ(answer.status, 408);
    EXPECT_EQ(answer.code(), "timeout");
    EXPECT_TRUE(client.ends());
  }
  // One that keeps dripping gets no more time than one that stops.
  Client dripping(server->port());
  dripping.send(start + "\r\n");
  while (dripping.send("x")) std::this_thread::sleep_for(milliseconds(2));
  EXPECT_EQ(server->counters().request_timeouts, 4u);
  EXPECT_EQ(server->counters().requests, 0u);
}

TEST(HttpServer, ClosesIdleConnections) {
  HttpLimits limits;
  limits.idle_time = milliseconds(50);
  auto server = serve(echo, limits);
  Client silent(server->port());
  EXPECT_TRUE(silent.ends());
  Client client(server->port());
  EXPECT_EQ(client.ask(get("/a")).status, 200);
  EXPECT_TRUE(client.ends());
  EXPECT_EQ(server->counters().idle_closed, 2u);
}

TEST(HttpServer, GivesUpOnAClientThatDoesNotReadItsAnswer) {
  HttpLimits limits;
  limits.write_time = milliseconds(50);
  auto server = serve(
      [](HttpRequest, HttpReply reply) {
        // More than the sockets' buffers take.
        reply({200, "text/plain", std::string(50'000'000, 'x'), {}});
      },
      limits);
  Client client(server->port());
  client.send(get("/a"));
  for (int i = 0; i < kPatienceMs && server->counters().write_timeouts == 0; ++i)
    std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(server->counters().write_timeouts, 1u);
}

TEST(HttpServer, ServesThreeHundredClientsAtOnce) {
  HttpLimits limits;
  limits.connections = 400;
  auto server = serve(echo, limits);
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 300; ++i) clients.push_back(std::make_unique<Client>(server->port()));
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(clients[i]->send(post("/a", std::to_string(i))));
    for (int i = 0; i < 300; ++i)
      ASSERT_EQ(clients[i]->receive().body, "POST /a [application/json] " + std::to_string(i));
  }
  EXPECT_EQ(server->counters().open, 300u);
}

TEST(HttpServer, TellsThoseOverTheLimitAndServesTheOthers) {
  HttpLimits limits;
  limits.connections = 256;
  auto server = serve(echo, limits);
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 300; ++i) {
    clients.push_back(std::make_unique<Client>(server->port()));
    ASSERT_TRUE(clients.back()->connected());
    ASSERT_TRUE(clients.back()->send(get("/a")));
  }
  int served = 0, refused = 0;
  for (auto& client : clients) {
    const auto answer = client->receive();
    served += answer.status == 200;
    refused += answer.status == 503;
  }
  EXPECT_EQ(served, 256);
  EXPECT_EQ(refused, 44);
  EXPECT_EQ(server->counters().refused, 44u);
  EXPECT_EQ(clients[0]->ask(get("/b")).status, 200);
}

TEST(HttpServer, TakesTheAnswerFromAnotherThreadAndOnlyOne) {
  Later later;
  auto server = serve(later.handler());
  Client client(server->port());
  for (int i = 0; i < 3; ++i) {
    client.send(get("/a"));
    auto reply = later.take();
    std::thread([&] {
      reply({200, "text/plain", "first", {}});
      reply({200, "text/plain", "second", {}});
    }).join();
    EXPECT_EQ(client.receive().body, "first");
  }
  EXPECT_EQ(server->counters().responses[2], 3u);
}

TEST(HttpServer, AnswersForAHandlerThatDropsOrThrows) {
  auto server = serve([](HttpRequest request, HttpReply) {
    if (request.target.path == "/throw") throw std::runtime_error("handler");
  });
  Client client(server->port());
  for (const char* path : {"/drop", "/throw", "/drop"}) {
    const auto answer = client.ask(get(path));
    EXPECT_EQ(answer.status, 500);
    EXPECT_EQ(answer.code(), "internal");
  }
  EXPECT_EQ(server->counters().failures, 3u);
}

TEST(HttpServer, SurvivesClientsThatLeave) {
  Later later;
  auto server = serve(later.handler());
  { Client(server->port()).send("POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\nabc"); }
  {
    Client client(server->port());
    client.send(get("/a"));
  }
  later.take()({200, "text/plain", "too late", {}});
  Client client(server->port());
  client.send(get("/a"));
  later.take()({200, "text/plain", "in time", {}});
  EXPECT_EQ(client.receive().body, "in time");
}

TEST(HttpServer, RefusesAPortInUseAndSaysSo) {
  auto server = serve(echo);
  const std::string port = std::to_string(server->port());
  auto second = HttpServer::start("127.0.0.1:" + port, echo);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().code, ErrorCode::kIo);
  EXPECT_NE(second.error().message.find("port " + port), std::string::npos);
  EXPECT_NE(second.error().message.find("--http"), std::string::npos);
  const auto released = server->port();
  server.reset();
  EXPECT_TRUE(HttpServer::start("127.0.0.1:" + std::to_string(released), echo).ok());
}

TEST(HttpServer, RefusesAddressesThatAreNone) {
  for (const char* address : {"", "7780", "localhost", "127.0.0.1:", "127.0.0.1:x", ":7780",
                              "127.0.0.1:70000", "127.0.0.1:-1", "::1:7780", "127.0.0.1:80 "}) {
    auto server = HttpServer::start(address, echo);
    ASSERT_FALSE(server.ok()) << address;
    EXPECT_EQ(server.error().code, ErrorCode::kInvalid) << server.error().text();
  }
  // 203.0.113.0/24 is for documentation (RFC 5737): no machine has it.
  auto elsewhere = HttpServer::start("203.0.113.1:0", echo);
  ASSERT_FALSE(elsewhere.ok());
  EXPECT_EQ(elsewhere.error().code, ErrorCode::kIo);
}

TEST(HttpServer, FinishesWhatHasBegunBeforeItStops) {
  Later later;
  HttpLimits limits;
  limits.linger_time = milliseconds(100);
  auto server = serve(later.handler(), limits);
  Client idle(server->port()), client(server->port());
  client.send(get("/a"));
  auto reply = later.take();
  std::thread stopping([&] { server->stop(milliseconds(kPatienceMs)); });
  EXPECT_TRUE(idle.ends());
  reply({200, "text/plain", "finished", {}});
  const auto answer = client.receive();
  EXPECT_EQ(answer.body, "finished");
  EXPECT_TRUE(answer.has("Connection: close\r\n"));
  stopping.join();
  EXPECT_FALSE(Client(server->port()).connected());
}

TEST(HttpServer, StopsWithoutAnAnswerWhenTheTimeIsUp) {
  Later later;
  auto server = serve(later.handler());
  Client client(server->port()), half(server->port());
  half.send("POST /a HTTP/1.1\r\n");
  client.send(get("/a"));
  auto reply = later.take();
  server->stop(milliseconds(20));
  server->stop(milliseconds(20));
  EXPECT_EQ(client.receive().status, 0);
  EXPECT_EQ(server->counters().open, 0u);
  server.reset();
  reply({200, "text/plain", "to nobody", {}});
}

TEST(HttpServer, StopsWhileClientsKeepAsking) {
  for (int round = 0; round < 5; ++round) {
    auto server = serve(echo);
    std::atomic<int> answered{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&] {
        for (;;) {
          Client client(server->port());
          if (!client.connected()) return;
          while (client.ask(get("/a")).status == 200) ++answered;
        }
      });
    while (answered < 100) std::this_thread::yield();
    server->stop(milliseconds(500));
    EXPECT_EQ(server->counters().open, 0u);
    for (auto& thread : threads) thread.join();
  }
}

}  // namespace
}  // namespace anchord
