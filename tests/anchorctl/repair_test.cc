// A damaged log: the daemon refuses to start on it, `anchorctl repair` makes one that it takes.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/anchorctl/run.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

constexpr int kFrames = 60;

void send_frames(DaemonProcess& daemon, int from, int to) {
  Client client(daemon.port());
  for (int n = from; n <= to; ++n)
    ASSERT_EQ(client.ask(post("/v1/detections", json(frame_number(n)))).status, 200);
}

/// Flips a bit of a symbol's name, in the last frame of the file.
void damage(const std::string& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto at = bytes.rfind("tea_box");
  ASSERT_NE(at, std::string::npos);
  file.clear();
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(bytes[at] ^ 1));
}

TEST(Repair, ADamagedLogIsRefusedAndSaved) {
  TestFolder folder;
  const std::string data = folder / "data", log = data + "/anchord.db";
  {
    DaemonProcess daemon(folder);
    ASSERT_TRUE(daemon.ready());
    send_frames(daemon, 1, kFrames);
    EXPECT_NE(run("repair '" + data + "' 2>&1").output.find("in use"), std::string::npos);
    EXPECT_EQ(daemon.end(SIGTERM), 0);
  }
  damage(log);
  const auto written = std::filesystem::last_write_time(log);
  {
    DaemonProcess daemon(folder);
    EXPECT_EQ(daemon.wait(), 1);
    const std::string errors = daemon.errors();
    const std::string advice = "`anchorctl repair " + data + "`";
    for (const std::string& words : {log + " is damaged", std::string("as it was written"), advice})
      EXPECT_NE(errors.find(words), std::string::npos) << errors;
  }
  EXPECT_EQ(std::filesystem::last_write_time(log), written);

  const Outcome repaired = run("repair '" + data + "'");
  EXPECT_EQ(repaired.status, 0);
  EXPECT_NE(repaired.output.find("saved 59 frames"), std::string::npos) << repaired.output;
  EXPECT_NE(repaired.output.find("lost 1: number "), std::string::npos) << repaired.output;
  EXPECT_NE(repaired.output.find(log + ".corrupt-1"), std::string::npos) << repaired.output;
  EXPECT_EQ(std::filesystem::last_write_time(log + ".corrupt-1"), written);

  DaemonProcess daemon(folder);
  ASSERT_TRUE(daemon.ready());
  EXPECT_EQ(counter(daemon.port(), "/log/frames"), kFrames - 1);
  send_frames(daemon, kFrames, kFrames + 1);
}

TEST(Repair, TakesBackWhatAWrongClockDid) {
  TestFolder folder;
  std::string before;
  {
    DaemonProcess daemon(folder);
    ASSERT_TRUE(daemon.ready());
    send_frames(daemon, 1, 10);
    before = belief(daemon.port());
    send_frames(daemon, 100, 105);
    EXPECT_EQ(ask(daemon.port(), post("/v1/detections", json(frame_number(11)))).status, 409);
    EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
  }
  const Outcome repaired =
      run("repair '" + (folder / "data") + "' --until " + std::to_string(frame_number(10).utime));
  EXPECT_NE(repaired.output.find("left out 6 "), std::string::npos) << repaired.output;
  DaemonProcess daemon(folder);
  ASSERT_TRUE(daemon.ready());
  EXPECT_EQ(belief(daemon.port()), before);
  send_frames(daemon, 11, 12);
}

TEST(Repair, WhatCannotBe) {
  TestFolder folder;
  const Outcome nowhere = run("repair '" + (folder / "none") + "' 2>&1");
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_NE(nowhere.output.find("there is no anchord.db"), std::string::npos) << nowhere.output;
  const Outcome when = run("repair . --until noon 2>&1");
  EXPECT_EQ(when.status, 1);
  EXPECT_NE(when.output.find("--until"), std::string::npos) << when.output;
  EXPECT_EQ(run("repair 2>&1").status, 2);
}

}  // namespace
}  // namespace anchord
