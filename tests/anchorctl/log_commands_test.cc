// What is exported of a log comes to the daemon's belief again; a log that is folded anew, too.

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "tests/anchorctl/run.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

constexpr int kFrames = 60;

class LogCommands : public ::testing::Test {
 protected:
  /// A daemon that is changed half-way, and has ended.
  void SetUp() override {
    live(kScene, 1, kFrames / 2);
    std::string green = kScene;
    green.replace(green.find("\"blue\""), 6, "\"blue\", \"green\"");
    live(green, kFrames / 2 + 1, kFrames);
  }
  void live(const std::string& scene, int from, int to) {
    DaemonProcess::Options options;
    options.scene = scene;
    options.checkpoint_interval = "0";
    DaemonProcess daemon(folder_, options);
    ASSERT_TRUE(daemon.ready());
    Client client(daemon.port());
    for (int n = from; n <= to; ++n)
      ASSERT_EQ(client.ask(post("/v1/detections", json(frame_number(n)))).status, 200);
    const std::string grasp = R"({"event":"named","object":"cup-1","name":"mug)" +
                              std::to_string(to) + R"(","utime":)" +
                              std::to_string(frame_number(to).utime) + "}";
    ASSERT_EQ(client.ask(post("/v1/events", grasp)).status, 200);
    believed_ = client.ask(get("/v1/objects")).body;
    history_ = client.ask(get("/v1/history?object=cup-1")).body;
    EXPECT_EQ(daemon.end(SIGTERM), 0);
  }
  /// The last line of what anchor-replay makes of a file.
  std::string replayed(const std::string& file) {
    const std::string out = folder_ / "world.jsonl";
    const std::string call = std::string(ANCHOR_REPLAY) + " --no-timing --all --input '" + file +
                             "' --output '" + out + "' 2>&1";
    EXPECT_EQ(std::system(call.c_str()), 0) << call;
    std::ifstream in(out);
    std::string line, last;
    while (std::getline(in, line)) last = line;
    return last;
  }
  std::string exported(const std::string& name, const std::string& options = "") {
    const std::string file = folder_ / name;
    const Outcome done =
        run("export '" + (folder_ / "data") + "' --output '" + file + "' " + options + " 2>&1");
    EXPECT_EQ(done.status, 0) << done.output;
    return file;
  }
  static std::string utime(int number) { return std::to_string(frame_number(number).utime); }

  TestFolder folder_;
  std::string believed_, history_;
};

TEST_F(LogCommands, WhatIsExportedComesToTheSameBelief) {
  const std::string whole = replayed(exported("whole.jsonl"));
  EXPECT_NE(whole.find("mug60"), std::string::npos) << whole;
  EXPECT_EQ(replayed(exported("whole.lcm")), whole);
  for (const int from : {2, 20, 31, 45})
    for (const char* name : {"span.jsonl", "span.lcm"})
      EXPECT_EQ(replayed(exported(name, "--from " + utime(from))), whole) << from << " " << name;
  const std::string half = replayed(exported("half.jsonl", "--to " + utime(20)));
  EXPECT_NE(half, whole);
  EXPECT_EQ(replayed(exported("part.lcm", "--from " + utime(10) + " --to " + utime(20))), half);
}

TEST_F(LogCommands, ExportSaysWhatItCannot) {
  EXPECT_EQ(run("export '" + (folder_ / "nowhere") + "' 2>&1").status, 1);
  const Outcome time = run("export '" + (folder_ / "data") + "' --from noon 2>&1");
  EXPECT_EQ(time.status, 1);
  EXPECT_NE(time.output.find("--from"), std::string::npos) << time.output;
}

TEST_F(LogCommands, ALogThatIsFoldedAnewGivesTheSame) {
  const Outcome rebuilt = run("rebuild '" + (folder_ / "data") + "' 2>&1");
  EXPECT_EQ(rebuilt.status, 0) << rebuilt.output;
  EXPECT_NE(rebuilt.output.find("62 frames and events"), std::string::npos) << rebuilt.output;
  EXPECT_EQ(rebuilt.output.find(" 0 B"), std::string::npos) << "a start goes on from a checkpoint";
  DaemonProcess::Options options;
  options.scene = kScene;
  std::string green = kScene;
  green.replace(green.find("\"blue\""), 6, "\"blue\", \"green\"");
  options.scene = green;
  DaemonProcess daemon(folder_, options);
  ASSERT_TRUE(daemon.ready());
  Client client(daemon.port());
  EXPECT_EQ(client.ask(get("/v1/objects")).body, believed_);
  EXPECT_FALSE(client.ask(get("/v1/history?object=cup-1")).body.empty());
}

}  // namespace
}  // namespace anchord
