#include "api/http_server.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/api/http_client.h"

namespace anchord {
namespace {

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
  HttpDoor anywhere;
  anywhere.beyond_loopback = true;
  auto elsewhere = HttpServer::start("203.0.113.1:0", echo, {}, anywhere);
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
