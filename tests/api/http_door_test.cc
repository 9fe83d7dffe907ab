#include "api/http_door.h"

#include <gtest/gtest.h>

#include "tests/api/http_client.h"

namespace anchord {
namespace {

constexpr char kToken[] = "correct-horse-battery-staple";

HttpDoor with_token() {
  return token_door(*BearerToken::parse(kToken),
                    [](std::string_view target) { return target == "/public"; });
}

/// A request with these fields alone.
std::string request(const std::string& method, const std::string& target,
                    const std::string& fields) {
  return method + " " + target + " HTTP/1.1\r\n" + fields + "\r\n";
}

std::string bearing(const std::string& authorization) {
  return "Host: x\r\nAuthorization: " + authorization + "\r\n";
}

TEST(HttpDoor, KnowsTheNamesOfThisMachine) {
  for (const char* own : {"localhost", "LocalHost:7780", "127.0.0.1", "127.0.0.1:7780",
                          "127.255.0.3:1", "[::1]", "[::1]:7780", "[0:0:0:0:0:0:0:1]:80"})
    EXPECT_TRUE(is_loopback_host(own)) << own;
  for (const char* other : {"",
                            ":7780",
                            "evil.example",
                            "evil.example:7780",
                            "localhost.evil.example",
                            "127.0.0.1.nip.io",
                            "localhost:7780.evil.example",
                            "128.0.0.1",
                            "0.0.0.0",
                            "10.0.0.1:7780",
                            "127.1",
                            "2130706433",
                            "0x7f.0.0.1",
                            "[::]",
                            "[::2]:7780",
                            "::1",
                            "[::1",
                            "[::1]x",
                            "localhost@evil.example",
                            "[::ffff:10.0.0.1]",
                            "127.0.0.1:77a",
                            "[]",
                            "[]:7780"})
    EXPECT_FALSE(is_loopback_host(other)) << other;
}

TEST(HttpDoor, ANameBoundToLoopbackIsNotServed) {
  auto server = serve(echo, {}, loopback_door());
  for (const char* method : {"GET", "HEAD", "POST", "DELETE", "OPTIONS"}) {
    Client client(server->port());
    client.send(request(method, "/v1/objects", "Host: evil.example:7780\r\n"));
    const auto answer = client.receive(method == std::string("HEAD"));
    EXPECT_EQ(answer.status, 421) << method;
    EXPECT_TRUE(method == std::string("HEAD") || answer.code() == "misdirected");
  }
  EXPECT_EQ(server->counters().foreign, 5u);
  EXPECT_EQ(server->counters().requests, 0u) << "nobody was handed it";
  EXPECT_EQ(Client(server->port()).ask(get("/a")).status, 200);
  EXPECT_EQ(Client(server->port()).ask("GET /a HTTP/1.0\r\n\r\n").status, 200)
      << "no browser leaves the host out";
}

TEST(HttpDoor, PagesOfOtherOriginsAreNotServed) {
  auto server = serve(echo, {}, loopback_door());
  const std::string host = "Host: localhost:7780\r\nContent-Length: 0\r\n";
  for (const char* foreign :
       {"http://evil.example", "null", "http://localhost:3000", "http://localhost", "",
        "ftp://localhost:7780", "http://127.0.0.1:7780", "http://localhost:7780.evil.example",
        "http://localhost:7780\r\nOrigin: http://localhost:7780"})
    for (const char* method : {"POST", "GET", "OPTIONS"}) {
      const auto answer =
          Client(server->port())
              .ask(request(method, "/v1/detections", host + "Origin: " + foreign + "\r\n"));
      EXPECT_EQ(answer.status, 403) << method << " " << foreign;
      EXPECT_EQ(answer.code(), "foreign_origin");
      EXPECT_FALSE(answer.has("Access-Control-Allow-Origin"));
    }
  EXPECT_EQ(server->counters().requests, 0u);
  for (const char* own : {"http://localhost:7780", "https://LOCALHOST:7780"})
    EXPECT_EQ(
        Client(server->port()).ask(request("POST", "/a", host + "Origin: " + own + "\r\n")).status,
        200)
        << own;
}

TEST(HttpDoor, NothingWithoutTheTokenButWhatIsPublic) {
  auto server = serve(echo, {}, with_token());
  int refused = 0;
  for (const std::string& fields :
       {std::string("Host: x\r\n"), bearing("Bearer wrong-horse-battery-staple"),
        bearing("Bearer "), bearing(std::string("Basic ") + kToken), bearing(kToken),
        bearing(std::string("Bearer ") + kToken + "\r\nAuthorization: Bearer " + kToken)})
    for (const char* target : {"/v1/objects", "/metrics", "/nothing", "/public/", "/"})
      for (const char* method : {"GET", "POST", "DELETE", "OPTIONS", "TRACE"}) {
        Client client(server->port());
        const auto answer = client.ask(request(method, target, fields));
        EXPECT_EQ(answer.status, 401) << method << " " << target << " " << fields;
        EXPECT_EQ(answer.code(), "unauthorized");
        EXPECT_TRUE(answer.has("WWW-Authenticate: Bearer realm=\"anchord\"")) << answer.head;
        EXPECT_EQ(answer.body.find(kToken), std::string::npos);
        EXPECT_TRUE(client.ends());
        ++refused;
      }
  EXPECT_EQ(server->counters().unauthorized, static_cast<std::uint64_t>(refused));
  EXPECT_EQ(server->counters().requests, 0u);
  EXPECT_EQ(Client(server->port()).ask(request("GET", "/public", "Host: x\r\n")).status, 200);
  EXPECT_EQ(Client(server->port()).ask(request("POST", "/public", "Host: x\r\n")).status, 401);
}

TEST(HttpDoor, WithTheTokenEverythingWhateverTheHostIsCalled) {
  auto server = serve(echo, {}, with_token());
  Client client(server->port());
  const std::string fields =
      "Host: robot.example\r\nOrigin: https://robot.example\r\n"
      "Authorization: bearer " +
      std::string(kToken) + "\r\n";
  for (const char* method : {"GET", "DELETE"})
    EXPECT_EQ(client.ask(request(method, "/v1/objects", fields)).status, 200);
  EXPECT_EQ(client.ask(request("POST", "/a", fields + "Content-Length: 2\r\n") + "hi").body,
            "POST /a [] hi");
}

TEST(HttpDoor, ABodyIsNotReadOfWhomItDoesNotLetIn) {
  auto server = serve(echo, {}, with_token());
  const auto answer = Client(server->port())
                          .ask(
                              "POST /a HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\n"
                              "Content-Length: 1000000\r\n\r\n");
  EXPECT_EQ(answer.status, 401) << "and no 100 before it";
}

/// What is said of an address that may not be served on.
std::string refusal(const std::string& address, HttpDoor door = {}) {
  const auto server = HttpServer::start(address, echo, {}, std::move(door));
  // An address that no machine has: who may listen there is refused by the kernel.
  if (server || server.error().code == ErrorCode::kIo) return "";
  return server.error().text();
}

TEST(HttpDoor, OnlyLoopbackWithoutAToken) {
  for (const char* open : {"0.0.0.0:0", "[::]:0", "192.0.2.1:0", "[::ffff:127.0.0.1]:0"}) {
    EXPECT_NE(refusal(open).find("--token-file"), std::string::npos) << open;
    EXPECT_NE(refusal(open, loopback_door()).find("--token-file"), std::string::npos) << open;
  }
  for (const char* loopback : {"127.0.0.1:0", "127.3.2.1:0", "localhost:0"})
    EXPECT_EQ(refusal(loopback, loopback_door()), "") << loopback;
  EXPECT_EQ(refusal("192.0.2.1:0", with_token()), "");
}

}  // namespace
}  // namespace anchord
