// anchorctl verify, name, join, drop, undo and event.

#include <gtest/gtest.h>

#include <deque>

#include "tests/anchorctl/canned_server.h"
#include "tests/anchorctl/run.h"
#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/task_wait.h"

namespace anchord {
namespace {

const std::string kTasks = R"({"verifications": [
  {"id": 1, "state": "found", "object": "cup-1", "robot": "amigo", "sensor": "eye", "gain": 3.256,
   "cost": 0.5, "created": 1700000000000000, "deadline": 1700000060000000,
   "ended": 1700000003200000, "reason": "it was found"},
  {"id": 2, "state": "issued", "object": "cup-2", "sensor": "eye", "gain": 1, "cost": 0,
   "created": 1700000000000000, "deadline": 1700000060000000, "reason": "a planner asked for it"},
  {"id": 3, "state": "queued", "object": "cup-3", "deadline": 1700090000000000, "reason": ""}]})";

TEST(VerifyText, OpenTasksNewestLast) {
  use_utc();
  EXPECT_EQ(verify_text(Json::parse(kTasks), kT, false, {}),
            "TASK  STATE   OBJECT  SENSOR  GAIN [nat]  COST  UNTIL / ENDED        REASON\n"
            "2     issued  cup-2   eye     1.00        0.00  22:14:20             a planner asked "
            "for it\n"
            "3     queued  cup-3   -       -           -     2023-11-15 23:13:20\n"
            "1 has ended (anchorctl verify --all)\n"
            "newest frame 2023-11-14 22:13:20 UTC\n");
}

TEST(VerifyText, EndedOnesTooIfAsked) {
  use_utc();
  Json answer = Json::parse(kTasks);
  answer["verifications"].erase(1), answer["verifications"].erase(1);
  EXPECT_EQ(verify_text(answer, kT, true, {}),
            "TASK  STATE  OBJECT  SENSOR        GAIN [nat]  COST  UNTIL / ENDED         REASON\n"
            "1     found  cup-1   eye of amigo  3.26        0.50  22:13:23 after 3.2 s  it was "
            "found\n"
            "newest frame 2023-11-14 22:13:20 UTC\n");
  answer["verifications"][0].erase("sensor");
  EXPECT_NE(verify_text(answer, kT, true, {}).find("any of amigo  -           -     "),
            std::string::npos)
      << "no gain without a sensor";
  EXPECT_EQ(verify_text(Json::object(), std::nullopt, true, {}), "no task\nnewest frame -\n");
  EXPECT_EQ(verify_text(Json::object(), std::nullopt, false, {}), "no open task\nnewest frame -\n");
}

TEST(TaskText, OneLine) {
  use_utc();
  const Json tasks = Json::parse(kTasks)["verifications"];
  EXPECT_EQ(task_text(tasks[0]), "task 1 (cup-1): found after 3.2 s, it was found\n");
  EXPECT_EQ(task_text(tasks[1]), "task 2 (cup-2): issued, until 22:14:20\n");
  EXPECT_EQ(task_text(Json::parse(R"({"id": null, "state": "not needed"})")),
            "no look is needed for that\n");
}

Answer task(const char* state) {
  const Json json{{"id", 7}, {"state", state}};
  return {json.dump(), json};
}

/// Waits for task 7, which is queued, with answers that come one after the other, the last one
/// again and again; a second passes between them. Without patience it is stopped after the first.
Result<Answer> waited(std::deque<Result<Answer>> answers, std::vector<std::string>& notes,
                      bool patient = true) {
  double now_s = 0;
  return wait_for_end(task("queued"),
                      {[&](const std::string& target) {
                         EXPECT_EQ(target, "/v1/verifications/7");
                         auto next = answers.front();
                         if (answers.size() > 1) answers.pop_front();
                         return next;
                       },
                       [&] { return now_s; }, [&](double) { return ++now_s < 2 || patient; },
                       [&](const std::string& line) { notes.push_back(line); }});
}

TEST(TaskWait, UntilItHasEnded) {
  std::vector<std::string> notes;
  const auto end = waited({task("queued"), task("issued"), task("missing")}, notes);
  ASSERT_TRUE(end.ok());
  EXPECT_EQ(text(end->json, "state"), "missing");
  EXPECT_TRUE(notes.empty());
  EXPECT_FALSE(went_well(end->json));
  EXPECT_TRUE(went_well(task("found").json));
}

TEST(TaskWait, OverARestartButNotForEver) {
  const Error silent{ErrorCode::kUnavailable, "", "no daemon"};
  std::vector<std::string> notes;
  EXPECT_TRUE(waited({silent, silent, task("issued"), task("found")}, notes).ok());
  EXPECT_EQ(notes, std::vector<std::string>{"no daemon; asking again"});
  EXPECT_EQ(waited({silent}, notes).error().message, "no daemon");
}

TEST(TaskWait, EndsWithARefusalOrWhenStopped) {
  std::vector<std::string> notes;
  EXPECT_EQ(waited({Error{ErrorCode::kUnknown, "id", "no task"}}, notes).error().field, "id");
  const auto stopped = waited({task("issued")}, notes, false);
  ASSERT_FALSE(stopped.ok());
  EXPECT_NE(stopped.error().message.find("--cancel 7"), std::string::npos);
}

TEST(VerifyProgram, SendsTriggers) {
  const std::string answer = R"({"id": 7, "state": "queued", "object": "cup-1",
                                 "deadline": 1700000060000000})";
  CannedServer server({{"POST /v1/verifications", http_response("201 Created", answer)},
                       {"DELETE /v1/verifications/7", http_response("200 OK", answer)}});
  const std::string at = " --server " + server.address();
  EXPECT_EQ(
      run("verify cup-1 --action grab --robot amigo --sensor eye --timeout 5 --alone" + at).output,
      "task 7 (cup-1): queued, until 22:14:20\n");
  run("verify cup 'color=light blue'" + at);
  run("verify --object 'my mug' --json" + at);
  run("verify --cancel 7" + at);
  EXPECT_EQ(server.asked(),
            (std::vector<std::string>{
                R"(POST /v1/verifications {"action":"grab","alone":true,"object":"cup-1",)"
                R"("robot":"amigo","sensor":"eye","timeout":5.0})",
                R"(POST /v1/verifications {"description":"class=cup&color=light%20blue"})",
                R"(POST /v1/verifications {"object":"my mug"})", "DELETE /v1/verifications/7"}));
}

TEST(VerifyProgram, StatusTellsWhetherItWasFound) {
  for (const auto& [state, status] :
       {std::pair("found", 0), std::pair("missing", 1), std::pair("occluded", 1),
        std::pair("expired", 1), std::pair("cancelled", 1)}) {
    const std::string end = R"({"id":7,"state":")" + std::string(state) + R"("})";
    CannedServer server({{"POST /v1/verifications",
                          http_response("201 Created", R"({"id": 7, "state": "queued"})")},
                         {"/v1/verifications/7", http_response("200 OK", end)}});
    const auto outcome = run("verify cup --wait --json --server " + server.address());
    EXPECT_EQ(outcome.status, status) << state;
    EXPECT_EQ(outcome.output, end + "\n") << "the end, and nothing before it";
  }
}

TEST(EventProgram, TellsAtTheTimeOfTheNewestFrame) {
  CannedServer server(
      {{"/v1/status", http_response("200 OK", R"({"utime": 1700000000000000})")},
       {"POST /v1/events", http_response("200 OK", R"({"accepted": 1, "number": 12})")}});
  const struct {
    std::string arguments, sent, output;
  } cases[] = {
      {"name cup-1 'my mug'", R"("event":"named","name":"my mug","object":"cup-1")",
       "cup-1 is called \"my mug\" now (event 12; take it back with anchorctl undo 12)\n"},
      {"name cup-1 ''", R"("event":"named","name":"","object":"cup-1")",
       "cup-1 has no other name now (event 12; take it back with anchorctl undo 12)\n"},
      {"join cup-1 cup-7", R"("event":"joined","object":"cup-1","other":"cup-7")",
       "cup-7 is cup-1 now (event 12; take it back with anchorctl undo 12)\n"},
      {"drop cup-9", R"("event":"dropped","object":"cup-9")",
       "cup-9 is no object any more (event 12; take it back with anchorctl undo 12)\n"},
      {"undo 11", R"("event":"undone","number":11)", "event 11 is taken back (event 12)\n"},
      {"event grasped cup-1 --robot amigo", R"("event":"grasped","object":"cup-1","robot":"amigo")",
       "cup-1 was grasped by amigo (event 12; it cannot be undone: tell what is so now)\n"},
      {"event placed cup-1 --place sink", R"("event":"placed","object":"cup-1","place":"sink")",
       "cup-1 was placed in sink (event 12; it cannot be undone: tell what is so now)\n"},
      {"event moved cup-1 --at -1 2.5 0.8",
       R"("event":"moved","object":"cup-1","position":[-1.0,2.5,0.8])",
       "cup-1 was moved to -1.00, 2.50, 0.80 m (event 12; it cannot be undone: tell what is so "
       "now)\n"},
      {"event removed cup-1", R"("event":"removed","object":"cup-1")",
       "cup-1 was removed (event 12; it cannot be undone: tell what is so now)\n"},
  };
  for (const auto& [arguments, sent, output] : cases) {
    const auto outcome = run(arguments + " --server " + server.address());
    EXPECT_EQ(outcome.status, 0) << arguments;
    EXPECT_EQ(outcome.output, output);
    EXPECT_EQ(server.asked().back(), "POST /v1/events {" + sent + R"(,"utime":1700000000000000})");
  }
}

TEST(EventProgram, FailsWhereNothingChanges) {
  CannedServer before({{"/v1/status", http_response("200 OK", R"({"utime": 0})")}});
  EXPECT_EQ(run("drop cup-1 --server " + before.address() + " 2>&1").status, 1);
  EXPECT_EQ(before.asked(), std::vector<std::string>{"/v1/status"});
  CannedServer again(
      {{"/v1/status", http_response("200 OK", R"({"utime": 1700000000000000})")},
       {"POST /v1/events", http_response("200 OK", R"({"accepted": 0, "repeated": 1})")}});
  const auto outcome = run("drop cup-1 --server " + again.address() + " 2>&1");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("nothing changed"), std::string::npos);
}

}  // namespace
}  // namespace anchord
