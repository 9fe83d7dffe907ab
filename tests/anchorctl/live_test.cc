// anchorctl and the daemon, each in a process of its own.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/anchorctl/run.h"
#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using Json = nlohmann::json;

class Live : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon_.ready()) << daemon_.errors();
    for (int n = 1; n <= 5; ++n) post("/v1/detections", json(frame_number(n)));
  }
  std::string server() const { return "127.0.0.1:" + std::to_string(daemon_.port()); }
  Outcome ctl(const std::string& arguments) { return run(arguments + " --server " + server()); }
  Json ctl_json(const std::string& arguments) {
    return Json::parse(ctl(arguments + " --json").output);
  }
  void post(const std::string& target, const std::string& body) {
    const Answer answer =
        ask(daemon_.port(),
            "POST " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" +
                "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
                "\r\n\r\n" + body);
    ASSERT_EQ(answer.status, 200) << answer.body;
  }
  Json object(const std::string& called) { return ctl_json("objects --object '" + called + "'"); }

  TestFolder folder_;
  DaemonProcess daemon_{folder_};
};

TEST(LiveDoor, ATokenIsReadFromAFile) {
  TestFolder folder;
  const auto file = [&](const std::string& name, const std::string& text) {
    const auto path = folder.write(name, text);
    std::filesystem::permissions(path, std::filesystem::perms(0600));
    return path;
  };
  const auto right = file("right", "correct-horse-battery-staple\n");
  const auto wrong = file("wrong", "correct-horse-battery-stapler\n");
  DaemonProcess daemon(folder, {},
                       {"--config", folder.write("scene.json", kScene), "--data", folder / "data",
                        "--lcm", "memq://", "--http", "127.0.0.1:0", "--token-file", right});
  ASSERT_TRUE(daemon.ready()) << daemon.errors();
  const std::string status = "status --server 127.0.0.1:" + std::to_string(daemon.port());
  EXPECT_EQ(run(status + " --token-file " + right).status, 0);
  EXPECT_EQ(run(status, "ANCHORD_TOKEN_FILE=" + right).status, 0);
  EXPECT_EQ(run(status + " --token-file " + right, "ANCHORD_TOKEN_FILE=" + wrong).status, 0)
      << "the option goes before the environment";
  for (const auto& refused : {run(status + " 2>&1"), run(status + " 2>&1 --token-file " + wrong)}) {
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.output.find("token"), std::string::npos) << refused.output;
    EXPECT_NE(refused.output.find("401"), std::string::npos) << refused.output;
  }
  std::filesystem::permissions(right, std::filesystem::perms(0644));
  const auto open = run(status + " 2>&1 --token-file " + right);
  EXPECT_EQ(open.status, 2);
  EXPECT_NE(open.output.find("chmod 600"), std::string::npos) << open.output;
}

TEST_F(Live, NamesAreGivenAndTakenBack) {
  const auto named = ctl("name cup-1 'my mug'");
  EXPECT_EQ(named.status, 0);
  EXPECT_NE(named.output.find("anchorctl undo 6"), std::string::npos)
      << "five frames came before: " << named.output;
  EXPECT_EQ(object("my mug")["id"], "cup-1");
  EXPECT_NE(ctl("objects").output.find("cup-1 (my mug)"), std::string::npos);
  EXPECT_EQ(ctl("undo 6").status, 0);
  EXPECT_FALSE(object("cup-1").contains("alias"));
  EXPECT_EQ(ctl("undo 6 2>&1").status, 1) << "it is taken back already";
}

TEST_F(Live, JoinKeepsTheFirstNameAndDropsAreUndone) {
  const Json listed = ctl_json("objects")["objects"];
  ASSERT_EQ(listed.size(), 2u);
  const std::string first = listed[0]["id"], second = listed[1]["id"];
  EXPECT_EQ(ctl("join " + first + " " + second).status, 0);
  EXPECT_EQ(ctl_json("objects")["objects"].size(), 1u);
  EXPECT_EQ(object(first)["id"], first);
  EXPECT_EQ(ctl("undo 6").status, 0);
  EXPECT_EQ(ctl("drop " + second).status, 0);
  EXPECT_EQ(ctl_json("objects")["objects"].size(), 1u);
  EXPECT_EQ(ctl("undo 8").status, 0);
  EXPECT_EQ(ctl_json("objects")["objects"].size(), 2u);
}

TEST_F(Live, WhatIsGraspedIsHeldUntilItIsPlaced) {
  EXPECT_EQ(ctl("event grasped cup-1 --robot amigo").status, 0);
  EXPECT_EQ(object("cup-1")["held_by"], "amigo");
  EXPECT_EQ(ctl("event placed cup-1 --at 3 2 0.8").status, 0);
  EXPECT_FALSE(object("cup-1").contains("held_by"));
  EXPECT_NEAR(object("cup-1")["position"][0].get<double>(), 3, 1e-9) << "as it was told";
  EXPECT_EQ(ctl("event removed cup-1").status, 0);
  EXPECT_EQ(ctl("objects cup-1 2>&1").status, 1);
}

TEST_F(Live, ALookIsAskedForListedAndEnds) {
  const Json task = ctl_json("verify cup color=red --timeout 1000");
  ASSERT_EQ(task["object"], "cup-1");
  const std::string id = task["id"].dump();
  EXPECT_TRUE(
      eventually([&] { return ctl_json("verify")["verifications"][0]["state"] == "issued"; }));
  EXPECT_EQ(ctl_json("verify --object cup-1")["id"], task["id"]) << "joined";
  post("/v1/verifications/" + id + "/result", R"({"outcome": "occluded"})");
  const std::string open = ctl("verify").output, all = ctl("verify --all").output;
  EXPECT_EQ(open.find("cup-1"), std::string::npos) << open;
  EXPECT_NE(all.find("occluded  cup-1"), std::string::npos) << all;
  EXPECT_EQ(ctl("verify --cancel " + id + " 2>&1").status, 1) << "it has ended";
}

TEST_F(Live, EveryDescribedCallIsServed) {
  const Json api = Json::parse(body(daemon_.port(), "/v1/openapi.json"));
  for (const auto& [path, methods] : api["paths"].items()) {
    std::string target = path;
    const std::size_t id = target.find("{id}");
    if (id != std::string::npos) target.replace(id, 4, "99");
    for (const std::string method : {"GET", "POST", "DELETE"}) {
      std::string key = method;
      for (char& c : key) c = static_cast<char>(std::tolower(c));
      if (!methods.contains(key)) continue;
      const Answer answer =
          ask(daemon_.port(), method + " " + target +
                                  " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" +
                                  "Content-Type: application/json\r\nContent-Length: 2\r\n\r\n{}");
      EXPECT_NE(answer.status, 0) << method << " " << target;
      EXPECT_NE(answer.status, 405) << method << " " << target;
      if (answer.status == 404) {
        EXPECT_NE(answer.body.find("99"), std::string::npos) << "another than: no such path";
      }
    }
  }
}

TEST_F(Live, WaitingEndsWithTheTask) {
  EXPECT_EQ(ctl("verify cup-1 --action release --wait").status, 0) << "needs no look";
  const auto expired = ctl("verify cup-1 --timeout 0.3 --wait");
  EXPECT_EQ(expired.status, 1);
  EXPECT_NE(expired.output.find("expired"), std::string::npos) << expired.output;
}

}  // namespace
}  // namespace anchord
