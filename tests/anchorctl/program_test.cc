// The program itself, against a server with prepared answers.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "tests/anchorctl/canned_server.h"
#include "tests/anchorctl/run.h"

namespace anchord {
namespace {

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

const std::string kCount =
    R"({"utime": 1700000000000000,  "distribution": [0.2, 0.8], "expected": 0.8})";

TEST(Program, AsksAndWritesForPeople) {
  CannedServer server(
      {{"/v1/count?class=cup&color=light%20blue&place=kitchen", http_response("200 OK", kCount)}});
  const auto outcome =
      run("count cup 'color=light blue' --place kitchen --server " + server.address());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output,
            "1 (0.80)  0 (0.20)\nexpected  0.80\nnewest frame 2023-11-14 22:13:20 UTC\n");
}

TEST(Program, JsonAsItCame) {
  CannedServer server({{"/v1/count", http_response("200 OK", kCount)}});
  const auto outcome = run("--json count", "ANCHORD_SERVER=" + server.address());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output, kCount + "\n");
}

TEST(Program, NamesOfCommandsMayBeClassesAndValues) {
  CannedServer server({});
  run("where count --place status --server " + server.address() + " 2>&1");
  EXPECT_EQ(server.asked(), std::vector<std::string>{"/v1/where?class=count&place=status"});
}

TEST(Program, LimitIsAParameter) {
  CannedServer server({{"/v1/hypotheses?limit=3", http_response("200 OK", R"({"worlds": []})")}});
  EXPECT_EQ(run("hypotheses --limit 3 --server " + server.address()).status, 0);
  EXPECT_EQ(run("hypotheses --limit x --server " + server.address() + " 2>&1").status, 2);
}

TEST(Program, TellsWhyTheDaemonRefused) {
  CannedServer server(
      {{"/v1/where?class=cpu", http_response("400 Bad Request",
                                             R"({"error": {"code": "invalid", "field": "class",
                                          "message": "there is no \"cpu\"; known: cup"}})")}});
  const auto outcome = run("where cpu --server " + server.address() + " 2>&1 >&-");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.output, "anchorctl: class: there is no \"cpu\"; known: cup (HTTP 400 from " +
                                server.address() + ")\n");
}

TEST(Program, TellsThatThereIsNoDaemon) {
  std::string address;
  { address = CannedServer({}).address(); }  // nobody listens there any more
  const auto outcome = run("status --server " + address + " 2>&1");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.output.rfind("anchorctl: no daemon at " + address, 0), 0u) << outcome.output;
  EXPECT_EQ(lines(outcome.output), 1u);
}

TEST(Program, OneLineAboutAnAnswerThatIsNone) {
  CannedServer server({{"/v1/status", "SSH-2.0-OpenSSH\r\n"},
                       {"/v1/count", http_response("200 OK", "<html>")},
                       {"/v1/objects", "HTTP/1.1 200 OK\r\nContent-Length: 100\r\n\r\n{"},
                       {"/v1/where?class=a", http_response("500 No", "\x1b[2J")}});
  for (const char* command : {"status", "count", "objects", "where a"}) {
    const auto outcome = run(std::string(command) + " --server " + server.address() + " 2>&1");
    EXPECT_EQ(outcome.status, 1) << command;
    EXPECT_EQ(lines(outcome.output), 1u) << outcome.output;
    EXPECT_NE(outcome.output.find(server.address()), std::string::npos) << outcome.output;
  }
}

TEST(Program, WrongCalls) {
  for (const char* arguments : {"",
                                "fly",
                                "where a b",
                                "where --color",
                                "status cup",
                                "count --server nowhere:x",
                                "watch --interval 0",
                                "watch cup-1",
                                "watch --for -1",
                                "verify --sensor eye",
                                "verify --cancel 0",
                                "verify --cancel 1 cup",
                                "verify --cancel 1 --wait",
                                "verify cup --all",
                                "verify cup-1 color=blue",
                                "verify cup --timeout -1",
                                "name cup-1",
                                "join cup-1",
                                "drop",
                                "undo x",
                                "undo 0",
                                "event lost cup-1",
                                "event grasped",
                                "event removed cup-1 --place sink",
                                "event grasped cup-1 --at 1 2",
                                "event placed cup-1 --at 1",
                                "event placed cup-1 --at 1 2 --place sink"}) {
    const auto outcome = run(std::string(arguments) + " 2>&1");
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(lines(outcome.output), 1u) << outcome.output;
  }
  EXPECT_EQ(run("count 2>&1", "ANCHORD_SERVER=a:b:c").status, 2);
}

TEST(Program, HelpIsNoFailure) {
  const auto outcome = run("where --help");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.output.find("--server"), std::string::npos);
}

TEST(Program, WatchEndsAfterItsTime) {
  CannedServer server({{"/v1/objects?class=cup&min_p=0.5",
                        http_response("200 OK", R"({"utime": 1700000000000000, "objects": [
                          {"id": "cup-1", "p": 0.9, "position": [1, 2], "place": null}]})")}});
  const auto outcome = run("watch cup --for 2 --server " + server.address());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output,
            "2023-11-14 22:13:20 UTC  cup-1  appeared: -, p 0.90, place -, at 1.00, 2.00 m\n");
}

TEST(Program, CtrlCEndsWatchWithoutFailure) {
  CannedServer server(
      {{"/v1/objects?min_p=0.5", http_response("200 OK", R"({"objects": [{"id": "cup-1"}]})")}});
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const std::string address = server.address();
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    execl(ANCHORCTL, "anchorctl", "watch", "--server", address.c_str(), nullptr);
    _exit(127);
  }
  close(ends[1]);
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 1);  // it has shown something, so it runs
  kill(child, SIGINT);
  int ended = -1;
  ASSERT_EQ(waitpid(child, &ended, 0), child);
  EXPECT_TRUE(WIFEXITED(ended) && WEXITSTATUS(ended) == 0) << ended;
  close(ends[0]);
}

}  // namespace
}  // namespace anchord
