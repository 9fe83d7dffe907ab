#include <gtest/gtest.h>

#include <mutex>
#include <thread>

#include "api/http_server.h"
#include "tests/api/http_client.h"

namespace anchord {
namespace {

TEST(HttpLimits, AsksForABodyThatTheClientHoldsBack) {
  auto server = serve(echo);
  Client client(server->port());
  client.send("POST /a HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  EXPECT_EQ(client.receive().status, 100);
  EXPECT_EQ(client.ask("hi").body, "POST /a [] hi");
  EXPECT_EQ(
      client.ask("POST /a HTTP/1.1\r\nHost: x\r\nExpect: tea\r\nContent-Length: 2\r\n\r\n").status,
      417);
}

TEST(HttpLimits, RefusesABodyOverTheLimitBeforeItIsSent) {
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

TEST(HttpLimits, DoesNotResetAClientThatGoesOnSendingAfterItsRefusal) {
  HttpLimits limits;
  limits.body_bytes = 1000;
  limits.linger_time = milliseconds(kPatienceMs);
  auto server = serve(echo, limits);
  Client client(server->port());
  client.send("POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 1000000\r\n\r\n");
  EXPECT_EQ(client.receive().status, 413);
  EXPECT_TRUE(client.ends());
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(client.send(std::string(100'000, 'x')));
    std::this_thread::sleep_for(milliseconds(1));
  }
}

TEST(HttpLimits, RefusesAChunkedBodyOverTheLimit) {
  HttpLimits limits;
  limits.body_bytes = 1000;
  auto server = serve(echo, limits);
  Client client(server->port());
  client.send("POST /a HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (int i = 0; i < 11; ++i) client.send("64\r\n" + std::string(100, 'x') + "\r\n");
  EXPECT_EQ(client.receive().status, 413);
}

TEST(HttpLimits, RefusesAHeaderOverTheLimitHoweverItComes) {
  HttpLimits limits;
  limits.header_bytes = 1000;
  auto server = serve(echo, limits);
  const std::string start = "GET /a HTTP/1.1\r\nHost: x\r\n";
  EXPECT_EQ(Client(server->port()).ask(start + "A: " + std::string(2000, 'x')).status, 431);
  EXPECT_EQ(Client(server->port()).ask("GET /" + std::string(2000, 'x')).status, 431);
  // Each piece ends within a field, so that the parser takes those before it out of the buffer.
  Client client(server->port());
  client.send(start + "F");
  for (int i = 0; i < 30; ++i) {
    client.send("ield-" + std::to_string(i) + ": " + std::string(40, 'x') + "\r\nF");
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

TEST(HttpLimits, RefusesWhatIsNoRequest) {
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

TEST(HttpLimits, RefusesABrokenEscapeAndReadsOn) {
  auto server = serve(echo);
  Client client(server->port());
  const auto answer = client.ask(get("/a?b=%zz"));
  EXPECT_EQ(answer.status, 400);
  EXPECT_EQ(nlohmann::json::parse(answer.body)["error"]["field"], "target");
  EXPECT_EQ(client.ask(get("/a?b=%7a")).body, "GET /a b=z [] ");
}

TEST(HttpLimits, GivesUpOnASlowRequest) {
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

TEST(HttpLimits, ClosesIdleConnections) {
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

TEST(HttpLimits, GivesUpOnAClientThatDoesNotReadItsAnswer) {
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

TEST(HttpLimits, TellsThoseOverTheLimitAndServesTheOthers) {
  HttpLimits limits;
  limits.connections = 256;
  std::mutex mutex;
  std::vector<HttpReply> replies;
  const auto count = [&] {
    std::lock_guard lock(mutex);
    return replies.size();
  };
  auto server = serve(
      [&](HttpRequest request, HttpReply reply) {
        if (request.target.path != "/a") return echo(std::move(request), std::move(reply));
        std::lock_guard lock(mutex);
        replies.push_back(std::move(reply));
      },
      limits);
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 300; ++i) {
    clients.push_back(std::make_unique<Client>(server->port()));
    ASSERT_TRUE(clients.back()->connected());
    ASSERT_TRUE(clients.back()->send(get("/a")));
    // None of those before is idle any more when the next one comes.
    for (int waited = 0; waited < kPatienceMs && i < 256 && count() <= std::size_t(i); ++waited)
      std::this_thread::sleep_for(milliseconds(1));
  }
  for (int i = 256; i < 300; ++i) {
    const auto answer = clients[i]->receive();
    EXPECT_EQ(answer.status, 503);
    EXPECT_EQ(answer.code(), "too_many_connections");
    EXPECT_TRUE(answer.has("Retry-After: 1\r\n")) << answer.head;
    EXPECT_TRUE(clients[i]->ends());
  }
  ASSERT_EQ(count(), 256u);
  for (auto& reply : replies) reply({200, "text/plain", "late", {}});
  for (int i = 0; i < 256; ++i) EXPECT_EQ(clients[i]->receive().status, 200);
  EXPECT_EQ(server->counters().refused, 44u);
  EXPECT_EQ(server->counters().evicted, 0u);
  EXPECT_EQ(clients[0]->ask(get("/b")).status, 200);
  replies.clear();
}

TEST(HttpLimits, TheConnectionThatIsIdleForLongestMakesRoom) {
  HttpLimits limits;
  limits.connections = 3;
  auto server = serve(echo, limits);
  // Whoever has been answered is idle in that order: 1, 2, 0. The client has its answer a little
  // before the server knows that all of it has gone.
  const auto rest = [] { std::this_thread::sleep_for(milliseconds(100)); };
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(std::make_unique<Client>(server->port()));
    EXPECT_EQ(clients.back()->ask(get("/a")).status, 200);
    rest();
  }
  EXPECT_EQ(clients[0]->ask(get("/a")).status, 200);
  rest();
  Client fourth(server->port());
  EXPECT_EQ(fourth.ask(get("/b")).status, 200);
  rest();
  EXPECT_TRUE(clients[1]->ends());
  Client fifth(server->port());
  EXPECT_EQ(fifth.ask(get("/c")).status, 200);
  EXPECT_TRUE(clients[2]->ends());
  EXPECT_EQ(clients[0]->ask(get("/d")).status, 200);
  EXPECT_EQ(server->counters().evicted, 2u);
  EXPECT_EQ(server->counters().refused, 0u);
}

TEST(HttpLimits, NobodyHoldsAllConnectionsBySayingNothing) {
  HttpLimits limits;
  limits.connections = 8;
  auto server = serve(echo, limits);
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 100; ++i) silent.push_back(std::make_unique<Client>(server->port()));
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(Client(server->port()).ask(get("/a")).body, "GET /a [] ") << i;
  EXPECT_LE(server->counters().open, 8u + 1) << "one that is leaving";
  EXPECT_EQ(server->counters().refused, 0u);
}

TEST(HttpLimits, RefusesATargetOverTheLimit) {
  HttpLimits limits;
  limits.target_bytes = 1000;
  auto server = serve(echo, limits);
  EXPECT_EQ(Client(server->port()).ask(get("/" + std::string(999, 'x'))).status, 200);
  const std::string line = "GET /" + std::string(1000, 'x');
  for (const std::string& request :
       {line + " HTTP/1.1\r\nHost: x\r\n\r\n", line, "GET /a?b=" + std::string(5000, 'x')}) {
    Client client(server->port());
    const auto answer = client.ask(request);
    EXPECT_EQ(answer.status, 414) << request;
    EXPECT_EQ(answer.code(), "target_too_long");
    EXPECT_TRUE(client.ends());
  }
  EXPECT_EQ(Client(server->port()).ask(std::string(20'000, 'x')).status, 431) << "no method's end";
}

}  // namespace
}  // namespace anchord
