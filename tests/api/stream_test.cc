// WebSockets of HttpServer: how clients are told, heard, and bidden farewell.

#include "api/stream.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/api/http_client.h"
#include "tests/api/stream_client.h"

namespace anchord {
namespace {

/// Counts up as fast as it is asked, in messages of a size; or hears what it must not.
struct Counter : StreamClient {
  Counter(std::atomic<int>& count, std::size_t size) : count_(count), size_(size) {}
  std::optional<Message> next() override {
    auto text = std::make_shared<std::string>(std::to_string(++count_));
    text->resize(std::max(size_, text->size()), ' ');
    return Message{std::move(text)};
  }
  milliseconds pause() const override { return pause_; }
  Status hear(std::string_view text) override {
    if (text == "wait") pause_ = milliseconds(1'000'000);
    return text == "bad" ? Status(invalid("text", "is bad")) : Status(Done{});
  }
  std::atomic<int>& count_;
  std::size_t size_;
  milliseconds pause_{0};
};

class Stream : public ::testing::Test {
 protected:
  void start(std::size_t size = 1, HttpLimits limits = {}) {
    server_ = *HttpServer::start(
        "127.0.0.1:0",
        [](const HttpRequest&, const HttpReply& reply) {
          reply({200, "text/plain", "hello", {}});
        },
        limits, {},
        [this, size](const HttpTarget& target,
                     const std::vector<std::string>& protocols) -> Result<StreamOpening> {
          if (target.path != "/numbers") return Error{ErrorCode::kUnknown, "", "no such stream"};
          return StreamOpening{std::make_unique<Counter>(count_, size),
                               protocols.empty() ? "" : protocols.back()};
        });
  }
  std::uint16_t port() const { return server_->port(); }

  std::atomic<int> count_{0};
  std::unique_ptr<HttpServer> server_;
};

TEST_F(Stream, TellsOneMessageAfterTheOther) {
  start();
  StreamClientSocket client(port(), "/numbers", "first, second");
  ASSERT_TRUE(client.open());
  EXPECT_EQ(client.protocol(), "second");
  for (int i = 1; i <= 100; ++i) ASSERT_EQ(client.hear(), std::to_string(i));
  EXPECT_EQ(server_->counters().streams, 1u);
  EXPECT_GE(server_->counters().streamed, 99u);
}

TEST_F(Stream, RefusesAsAnyRequest) {
  start(1, {.streams = 1});
  EXPECT_EQ(StreamClientSocket(port(), "/elsewhere").status(), 404);
  Client plain(port());
  plain.send("GET /numbers HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_EQ(plain.receive().body, "hello") << "who asks for no WebSocket is the handler's";
  StreamClientSocket first(port(), "/numbers");
  EXPECT_EQ(StreamClientSocket(port(), "/numbers").status(), 503);
  EXPECT_TRUE(first.open());
}

TEST_F(Stream, QueuesNothingForWhoDoesNotRead) {
  constexpr std::size_t kSize = 1 << 20;
  start(kSize);
  StreamClientSocket slow(port(), "/numbers");
  ASSERT_TRUE(slow.open());
  int before = -1;
  while (before != count_) {  // until the kernel's buffers are full
    before = count_;
    std::this_thread::sleep_for(milliseconds(200));
  }
  EXPECT_LT(count_, 64) << "as many as the kernel takes, and one more";
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(std::stoi(slow.hear()), i);
}

TEST_F(Stream, ClosesWhoSaysWhatCannotBe) {
  start();
  StreamClientSocket client(port(), "/numbers");
  client.say("bad");
  while (!client.hear().empty()) {
  }
  EXPECT_EQ(client.close_code(), 1008);
  EXPECT_NE(client.close_reason().find("is bad"), std::string::npos) << client.close_reason();
}

TEST_F(Stream, AClientsMessageIsBounded) {
  start();
  StreamClientSocket client(port(), "/numbers");
  client.say(std::string(1 << 20, 'x'));
  while (!client.hear().empty()) {
  }
  // The server says 1009, but what it has not read resets the connection, and that word with it.
  EXPECT_FALSE(client.open());
  const auto gone = [&] { return server_->counters().streams == 0; };
  for (int i = 0; i < kPatienceMs / 10 && !gone(); ++i)
    std::this_thread::sleep_for(milliseconds(10));
  EXPECT_TRUE(gone());
}

TEST_F(Stream, SaysGoodbye) {
  start();
  StreamClientSocket client(port(), "/numbers");
  ASSERT_EQ(client.hear(), "1");
  std::thread stopping([&] { server_->stop(milliseconds(kPatienceMs)); });
  while (!client.hear().empty()) {
  }
  stopping.join();
  EXPECT_EQ(client.close_code(), 1001);
  EXPECT_EQ(server_->counters().streams, 0u);
  EXPECT_EQ(server_->counters().open, 0u);
}

TEST_F(Stream, WhoShowsNoSignOfLifeIsGone) {
  start(1, {.stream_idle_time = milliseconds(200)});
  Client dead(port());
  dead.send(
      "GET /numbers HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  const auto gone = [&] { return server_->counters().streams == 0; };
  while (server_->counters().responses[1] == 0) std::this_thread::sleep_for(milliseconds(5));
  for (int i = 0; i < kPatienceMs / 10 && !gone(); ++i)
    std::this_thread::sleep_for(milliseconds(10));
  EXPECT_TRUE(gone());
}

TEST(StreamProtocols, AreReadFromTheField) {
  EXPECT_EQ(offered_protocols(" a ,b,, c.1\t"), (std::vector<std::string>{"a", "b", "c.1"}));
  EXPECT_TRUE(offered_protocols("").empty());
  EXPECT_EQ(offered_token("anchord.v1, anchord.token.c2VjcmV0Pz8_"), "secret???");
  EXPECT_EQ(offered_token("anchord.token.c2VjcmV0"), "secret");
  EXPECT_EQ(offered_token("anchord.v1"), std::nullopt);
  EXPECT_EQ(offered_token("anchord.token.c2V$"), std::nullopt);
}

}  // namespace
}  // namespace anchord
