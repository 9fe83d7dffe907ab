// Nothing acknowledged is lost, however the program ends, and the belief is that of the log.

#include <atomic>
#include <cmath>
#include <csignal>
#include <set>

#include "knowledge/frame_log.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"
#include "tests/daemon/daemon_process.h"
#include "tests/daemon/load.h"

namespace anchord {
namespace {

std::vector<Frame> logged(const TestFolder& folder) {
  std::vector<Frame> frames;
  auto log = FrameLog::open(folder / "data");
  EXPECT_TRUE(log.ok());
  const auto read = (*log)->for_each(1, [&](const LoggedFrame& frame) {
    auto message = decode_frame(frame.bytes);
    EXPECT_TRUE(message.ok());
    frames.push_back(std::move(message->frame));
    return true;
  });
  EXPECT_TRUE(read.ok());
  return frames;
}

void expect_all_logged(const std::set<std::pair<std::string, Utime>>& acknowledged,
                       const std::vector<Frame>& log) {
  std::set<std::pair<std::string, Utime>> kept;
  for (const Frame& frame : log) kept.insert({frame.sensor, frame.utime});
  EXPECT_EQ(kept.size(), log.size()) << "each frame is there once";
  for (const auto& frame : acknowledged)
    EXPECT_TRUE(kept.contains(frame)) << frame.first << " " << frame.second << " is lost";
}

TEST(Restart, NothingAcknowledgedIsLostByKills) {
  TestFolder folder;
  std::atomic<int> next{0};
  std::set<std::pair<std::string, Utime>> acknowledged;
  for (int round = 0; round < 4; ++round) {
    DaemonProcess daemon(folder);
    ASSERT_TRUE(daemon.ready());
    ASSERT_EQ(counter(daemon.port(), "/frames/accepted"), 0);
    Load load(daemon.port(), next);
    ASSERT_TRUE(eventually([&] { return load.count() >= 30; }));
    EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
    load.join();
    acknowledged.insert(load.acknowledged().begin(), load.acknowledged().end());
  }
  const std::vector<Frame> log = logged(folder);
  expect_all_logged(acknowledged, log);

  // The belief after the last restart is that of a daemon that was never killed, to the byte.
  DaemonProcess restarted(folder);
  DaemonProcess::Options elsewhere;
  elsewhere.data = "fresh";
  DaemonProcess fresh(folder, elsewhere);
  ASSERT_TRUE(restarted.ready() && fresh.ready());
  Client client(fresh.port());
  for (const Frame& frame : log)
    ASSERT_EQ(client.ask(post("/v1/detections", json(frame))).status, 200);
  EXPECT_EQ(belief(restarted.port()), belief(fresh.port()));
  EXPECT_EQ(counter(restarted.port(), "/log/frames"), static_cast<std::int64_t>(log.size()));
  // What the client did not get an answer to it sends again; here everything.
  for (const Frame& frame : {log.front(), log.back()})
    EXPECT_EQ(ask(restarted.port(), post("/v1/detections", json(frame))).body,
              "{\"accepted\":0,\"repeated\":1}\n");
}

/// Cups that stand close together, and where they are seen to and fro.
Frame crowded(int number) {
  Frame frame = frame_number(number);
  const Detection cup = frame.detections.front();
  frame.detections.clear();
  for (int i = 0; i < 8; ++i) {
    if ((i + number) % 5 == 0) continue;  // missed
    Detection& seen = frame.detections.emplace_back(cup);
    std::get<CartesianMeasurement>(seen.measurement).position[1] =
        3 + 0.05 * i + 0.02 * std::cos(i * number);
  }
  return frame;
}

TEST(Restart, WorkThatWasBoundedIsBoundedAlikeAgain) {
  TestFolder folder;
  DaemonProcess::Options options;
  const std::string scene = options.scene.substr(0, options.scene.rfind('}'));
  options.scene = scene + R"(, "hypotheses": {"frame_budget": 2e-5}})";
  std::string before;
  {
    DaemonProcess daemon(folder, options);
    ASSERT_TRUE(daemon.ready());
    for (int number = 1; number <= 40; ++number)
      ASSERT_EQ(ask(daemon.port(), post("/v1/detections", json(crowded(number)))).status, 200);
    EXPECT_GT(counter(daemon.port(), "/frames/cut"), 0);
    before = belief(daemon.port());
    EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
  }
  // What each frame was allowed hung on the clock; it stands in the log.
  std::set<std::int64_t> bounds;
  {
    auto log = FrameLog::open(folder / "data");
    ASSERT_TRUE(log.ok());
    ASSERT_TRUE((*log)
                    ->for_each(1,
                               [&](const LoggedFrame& frame) {
                                 bounds.insert(frame.work.value_or(-1));
                                 return true;
                               })
                    .ok());
  }
  EXPECT_GT(bounds.size(), 1u);
  EXPECT_GT(*bounds.begin(), 0);
  options.scene = scene + R"(, "hypotheses": {"frame_budget": 10}})";
  DaemonProcess restarted(folder, options);
  ASSERT_TRUE(restarted.ready());
  EXPECT_EQ(belief(restarted.port()), before) << "by the bounds in the log, not by a new budget";
}

TEST(Restart, ATerminationUnderLoadIsClean) {
  TestFolder folder;
  std::atomic<int> next{0};
  std::string before;
  for (const int signal : {SIGTERM, SIGINT}) {
    DaemonProcess daemon(folder);
    ASSERT_TRUE(daemon.ready());
    Load load(daemon.port(), next);
    Client idle(daemon.port());
    Client slow(daemon.port());  // has begun a request that never ends
    slow.send("POST /v1/detections HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n{");
    ASSERT_TRUE(eventually([&] { return load.count() >= 30; }));
    EXPECT_EQ(daemon.end(signal), 0) << daemon.errors();
    load.join();
    expect_all_logged(load.acknowledged(), logged(folder));
  }
}

TEST(Restart, ATerminationEndsARestoreToo) {
  TestFolder folder;
  constexpr int kHistory = 3000;
  {
    auto log = FrameLog::open(folder / "data");
    ASSERT_TRUE(log.ok());
    for (int i = 1; i <= kHistory; ++i) {
      const Frame frame = frame_number(i);
      ASSERT_TRUE((*log)
                      ->append({LoggedFrame::Kind::kFrame, i, frame.utime, "", frame.sensor,
                                canonical_bytes(frame)})
                      .ok());
    }
    ASSERT_TRUE((*log)->commit().ok());
  }
  std::uint16_t port = 0;
  {
    DaemonProcess daemon(folder);
    ASSERT_TRUE(daemon.ready());
    port = daemon.port();  // free once more when it has ended
    EXPECT_EQ(counter(port, "/log/frames"), kHistory);
    EXPECT_EQ(daemon.end(SIGTERM), 0);
  }
  DaemonProcess::Options same;
  same.http = "127.0.0.1:" + std::to_string(port);
  DaemonProcess daemon(folder, same);
  // It listens before it has restored. Whether it still restores when asked is up to the machine.
  ASSERT_TRUE(eventually([&] { return Client(port).connected(); })) << daemon.errors();
  const auto status = nlohmann::json::parse(body(port, "/v1/status"));
  if (status["ready"] == false) {
    const Answer early = ask(port, post("/v1/detections", json(frame_number(kHistory + 1))));
    EXPECT_TRUE(early.status == 503 || early.status == 200) << early.body;
  }
  EXPECT_EQ(daemon.end(SIGTERM), 0) << daemon.errors();
  EXPECT_GE(logged(folder).size(), static_cast<std::size_t>(kHistory));
}

}  // namespace
}  // namespace anchord
