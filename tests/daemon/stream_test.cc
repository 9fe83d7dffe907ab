// GET /v1/stream: what who watches is told.

#include <sys/stat.h>

#include <csignal>
#include <thread>

#include "tests/api/stream_client.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using nlohmann::json;

class StreamTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(daemon_.ready()); }
  void send(int number) {
    ASSERT_EQ(
        ask(daemon_.port(), post("/v1/detections", anchord::json(frame_number(number)))).status,
        200);
  }

  TestFolder folder_;
  DaemonProcess daemon_{folder_};
};

/// What a message makes of what was told before.
void take(json& world, const json& message) {
  if (message.contains("world"))
    world = message["world"];
  else
    world.merge_patch(message.at("change"));
}

TEST_F(StreamTest, TheWholeWorldThenWhatChanges) {
  for (int i = 1; i <= 3; ++i) send(i);
  StreamClientSocket client(daemon_.port(), "/v1/stream?rate=50", "anchord.v1");
  ASSERT_TRUE(client.open());
  EXPECT_EQ(client.protocol(), "anchord.v1");
  const json first = client.hear_json();
  EXPECT_EQ(first["seq"], 1);
  json world = first["world"];
  EXPECT_EQ(world["utime"], frame_number(3).utime);
  ASSERT_TRUE(world["objects"].contains("cup-1")) << world;
  std::size_t most = 0;
  for (int i = 4; i <= 12; ++i) {
    send(i);
    do {
      const std::string bytes = client.hear();
      const json message = json::parse(bytes);
      EXPECT_TRUE(message.contains("change")) << message;
      take(world, message);
      most = std::max(most, bytes.size());
    } while (world["utime"] < frame_number(i).utime);
  }
  EXPECT_LT(most, first.dump().size());
  StreamClientSocket later(daemon_.port());
  EXPECT_EQ(later.hear_json()["world"], world) << "the changes lead where a new client begins";
  const auto cup = json::parse(body(daemon_.port(), "/v1/objects/cup-1"));
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(world["objects"]["cup-1"]["position"][i].get<double>(),
                cup["position"][i].get<double>(), 1e-3);
  EXPECT_EQ(world["objects"]["cup-1"]["place"], "kitchen");
  EXPECT_EQ(world["objects"]["cup-1"]["attributes"]["color"], "red");
}

TEST_F(StreamTest, WhoFallsBehindIsToldOfTheNewestOnly) {
  send(1);
  StreamClientSocket client(daemon_.port(), "/v1/stream?rate=2");
  json world = client.hear_json()["world"];
  for (int i = 2; i <= 40; ++i) send(i);  // of which it reads nothing meanwhile
  int messages = 0;
  for (; world["utime"] < frame_number(40).utime; ++messages) take(world, client.hear_json());
  EXPECT_LT(messages, 39) << "one for each frame";
  ASSERT_TRUE(client.say(R"({"rate": 50, "something": "else"})"));
  send(41);
  while (world["utime"] < frame_number(41).utime) take(world, client.hear_json());
  EXPECT_EQ(counter(daemon_.port(), "/http/streams"), 1);
}

TEST_F(StreamTest, TasksAreTold) {
  for (int i = 1; i <= 5; ++i) send(i);
  StreamClientSocket client(daemon_.port(), "/v1/stream?rate=50");
  json world = client.hear_json()["world"];
  ASSERT_EQ(ask(daemon_.port(), post("/v1/verifications", R"({"object": "cup-1"})")).status, 201);
  while (world["tasks"].empty()) take(world, client.hear_json());
  EXPECT_EQ(world["tasks"].begin()->at("object"), "cup-1");
}

TEST_F(StreamTest, WhatCannotBeIsRefused) {
  for (const char* target : {"/v1/stream?rate=0", "/v1/stream?rate=fast", "/v1/stream?speed=1",
                             "/v1/stream?rate=nan", "/v1/stream?rate="})
    EXPECT_EQ(StreamClientSocket(daemon_.port(), target).status(), 400) << target;
  EXPECT_EQ(StreamClientSocket(daemon_.port(), "/v1/objects").status(), 404);
  EXPECT_EQ(ask(daemon_.port(), get("/v1/stream")).status, 426);
  for (const char* bad : {"rate", "[1]", R"({"rate": 0})", R"({"rate": "fast"})"}) {
    StreamClientSocket client(daemon_.port());
    client.hear();
    client.say(bad);
    while (!client.hear().empty()) {
    }
    EXPECT_EQ(client.close_code(), 1008) << bad;
  }
  EXPECT_EQ(counter(daemon_.port(), "/http/streams_refused"), 4);
}

TEST_F(StreamTest, TheEndIsToldAndAnotherBeginningServesAgain) {
  send(1);
  StreamClientSocket client(daemon_.port());
  client.hear();
  std::thread ending([&] { EXPECT_EQ(daemon_.end(SIGTERM), 0); });
  while (!client.hear().empty()) {
  }
  ending.join();
  EXPECT_EQ(client.close_code(), 1001);
  DaemonProcess again(folder_);
  ASSERT_TRUE(again.ready());
  StreamClientSocket back(again.port());
  EXPECT_EQ(back.hear_json()["world"]["utime"], frame_number(1).utime);
}

TEST(StreamDoor, ABrowserBringsItsTokenAsAProtocol) {
  TestFolder folder;
  const auto token = folder.write("token", "correct-horse-battery-staple\n");
  chmod(token.c_str(), 0600);
  DaemonProcess daemon(folder, {},
                       {"--config", folder.write("scene.json", kScene), "--data", folder / "data",
                        "--lcm", "memq://", "--http", "127.0.0.1:0", "--token-file", token});
  ASSERT_TRUE(daemon.ready());
  const std::string good = "anchord.token.Y29ycmVjdC1ob3JzZS1iYXR0ZXJ5LXN0YXBsZQ";
  StreamClientSocket client(daemon.port(), "/v1/stream", "anchord.v1, " + good);
  ASSERT_TRUE(client.open()) << client.status();
  EXPECT_EQ(client.protocol(), "anchord.v1");
  for (const std::string bad : {"", "anchord.v1", "anchord.v1, anchord.token.Y29ycmVjdA"})
    EXPECT_EQ(StreamClientSocket(daemon.port(), "/v1/stream", bad).status(), 401) << bad;
}

}  // namespace
}  // namespace anchord
