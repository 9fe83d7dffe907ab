#include <gtest/gtest.h>

#include "tests/anchorctl/utc.h"
#include "tools/anchorctl/answers.h"

namespace anchord {
namespace {

class Text : public testing::Test {
 protected:
  void SetUp() override { use_utc(); }
};

TEST_F(Text, Where) {
  const Json answer = Json::parse(R"({"utime": 1700000003200000, "answers": [
    {"object": "cup-1", "p": 0.93, "match": 0.98, "position": [1.02, 0.2, 0.9],
     "covariance": [0.0004,0,0, 0,0.0025,0, 0,0,0.0001], "last_seen": 1700000000000000,
     "places": [{"place": "kitchen_table", "p": 0.68, "parent": "kitchen"},
                {"place": "kitchen", "p": 0.88, "parent": null},
                {"place": "sink", "p": 0.2, "parent": "kitchen"},
                {"place": null, "p": 0.12}]},
    {"object": "new-7", "p": 0.004}],
    "undetected": [{"place": "kitchen", "expected": 0.3}, {"place": "bedroom", "expected": 1.25},
                   {"place": "sink", "expected": 0.001}]})");
  EXPECT_EQ(where_text(answer, {}),
            "OBJECT  P      MATCH  PLACES                                         POSITION [m]     "
            "       LAST SEEN\n"
            "cup-1   0.93   0.98   kitchen_table 0.68, sink 0.20, elsewhere 0.12  1.02, 0.20, 0.90 "
            "±0.05  22:13:20 (3.2 s ago)\n"
            "new-7   0.004  -      elsewhere 1.00                                 -                "
            "       -\n"
            "\n"
            "NOT YET SEEN  EXPECTED\n"
            "bedroom       1.25\n"
            "kitchen       0.30\n"
            "newest frame 2023-11-14 22:13:23 UTC\n");
}

TEST_F(Text, WhereFitsItsTerminal) {
  const Json answer = Json::parse(R"({"utime": 1700000003200000, "answers": [
    {"object": "cup-1", "p": 0.93, "match": 0.98, "position": [1.02, 0.2, 0.9],
     "last_seen": 1700000000000000,
     "places": [{"place": "kitchen_table", "p": 0.68}, {"place": "sink", "p": 0.2}]}]})");
  EXPECT_EQ(where_text(answer, {false, 72, 24}),
            "OBJECT  P     MATCH  PLACES               POSITION [m]      LAST SEEN\n"
            "cup-1   0.93  0.98   kitchen_table 0.68,  1.02, 0.20, 0.90  22:13:20\n"
            "                     sink 0.20,                             (3.2 s ago)\n"
            "                     elsewhere 0.12\n"
            "newest frame 2023-11-14 22:13:23 UTC\n");
}

TEST_F(Text, WhereNobodyIs) {
  EXPECT_EQ(where_text(Json::parse(R"({"utime": 0, "answers": []})"), {}),
            "no object that has been seen fits\nnewest frame -\n");
}

constexpr const char* kCup = R"("id": "cup-1", "p": 0.97, "position": [1.02, 0.2],
  "covariance": [0.0004, 0, 0, 0.0025], "velocity": [0.3, 0.4], "yaw": 1.5707963,
  "attributes": {"class": {"cup": 0.98, "mug": 0.02}, "color": {"blue": 0.9, "green": 0.1},
                 "size": {"mean": 0.12, "variance": 0.0004}},
  "last_seen": 1700000000000000, "place": "kitchen_table", "in_best": true)";

TEST_F(Text, Objects) {
  const Json answer = Json::parse(std::string(R"({"utime": 1700000000000000, "objects": [{)") +
                                  kCup + R"(}, {"id": "new-3", "p": 0.02, "place": null}]})");
  EXPECT_EQ(objects_text(answer, {}),
            "OBJECT  P     CLASS     PLACE          POSITION [m]      LAST SEEN       ATTRIBUTES\n"
            "cup-1   0.97  cup 0.98  kitchen_table  1.02, 0.20 ±0.05  22:13:20 (now)  "
            "color blue 0.90, size 0.120 ±0.020\n"
            "new-3   0.02  -         -              -                 -               -\n"
            "newest frame 2023-11-14 22:13:20 UTC\n");
}

TEST_F(Text, ObjectsThatPeopleNameAndRobotsHold) {
  const Json held = {{"id", "cup-1"}, {"p", 0.9}, {"place", "kitchen"}, {"held_by", "amigo"}};
  Json named = held;
  named["alias"] = "my mug";
  named["held_by"] = "";  // the only robot
  EXPECT_EQ(objects_text(Json{{"objects", {held, named}}}, {}),
            "OBJECT          P     CLASS  PLACE                       POSITION [m]  LAST SEEN  "
            "ATTRIBUTES\n"
            "cup-1           0.90  -      kitchen, held by amigo      -             -          -\n"
            "cup-1 (my mug)  0.90  -      kitchen, held by the robot  -             -          -\n"
            "newest frame -\n");
  EXPECT_EQ(objects_text(named, {}),
            "object     cup-1\n"
            "called     my mug\n"
            "exists     0.90\n"
            "place      kitchen, held by the robot\n"
            "last seen  -\n"
            "newest frame -\n");
}

TEST_F(Text, OneObject) {
  const Json answer = Json::parse(std::string(R"({"utime": 1700000060000000, )") + kCup + R"(,
    "extent": [0.08, 0.08, 0.1],
    "models": [{"kind": "constant_velocity", "weight": 0.9, "position": [1.02, 0.2]},
               {"kind": "somewhere", "weight": 0.1, "place": "kitchen"}],
    "alternatives": [{"p": 0.8, "position": [1.02, 0.2], "place": "kitchen_table",
                      "class": "cup"}]})");
  EXPECT_EQ(objects_text(answer, {}),
            "object     cup-1\n"
            "exists     0.97, in the best world\n"
            "class      cup 0.98, mug 0.02\n"
            "color      blue 0.90, green 0.10\n"
            "size       0.120 ±0.020\n"
            "place      kitchen_table\n"
            "position   1.02 ±0.02, 0.20 ±0.05 m\n"
            "velocity   0.30, 0.40 m/s (0.50 m/s)\n"
            "yaw        1.57 rad (90 degrees)\n"
            "extent     0.08, 0.08, 0.10 m\n"
            "last seen  22:13:20 (60 s ago)\n"
            "\n"
            "MODEL              WEIGHT  PLACE    POSITION [m]\n"
            "constant_velocity  0.90    -        1.02, 0.20\n"
            "somewhere          0.10    kitchen  -\n"
            "\n"
            "ALTERNATIVE  PLACE          CLASS  POSITION [m]\n"
            "0.80         kitchen_table  cup    1.02, 0.20\n"
            "newest frame 2023-11-14 22:14:20 UTC\n");
}

TEST_F(Text, Count) {
  EXPECT_EQ(count_text(Json::parse(R"({"utime": 1700000000000000,
              "distribution": [0.001, 0.2, 0.79, 0.009], "expected": 1.78, "undetected": 0.3})"),
                       {}),
            "2 (0.79)  1 (0.20)  3 (0.009)\n"
            "expected      1.78\n"
            "not yet seen  0.30 more expected\n"
            "newest frame 2023-11-14 22:13:20 UTC\n");
  EXPECT_EQ(count_text(Json::parse(R"({"distribution": [1]})"), {}), "0 (1.00)\nnewest frame -\n");
}

TEST_F(Text, Hypotheses) {
  const Json answer = Json::parse(R"({"utime": 1700000000000000, "clusters": 1, "hypotheses": 12,
    "worlds": [
      {"p": 0.61, "objects": [{"id": "cup-1", "p": 0.97, "position": [1, 2], "class": "cup"}],
       "differs": []},
      {"p": 0.3, "differs": [
        {"object": "cup-1", "change": "moved", "position": [1.5, 2], "best_position": [1, 2]},
        {"object": "cup-2", "change": "present", "position": [3, 4]}]},
      {"p": 0.05, "differs": [
        {"object": "cup-1", "change": "absent", "best_position": [1, 2]}]},
      {"p": 0.04, "differs": [
        {"object": "cup-1", "change": "class", "class": "mug", "position": [1, 2]}]}]})");
  EXPECT_EQ(hypotheses_text(answer, {}),
            "12 hypotheses in 1 cluster\n"
            "\n"
            "World 1, p 0.61\n"
            "OBJECT  P     CLASS  POSITION [m]\n"
            "cup-1   0.97  cup    1.00, 2.00\n"
            "\n"
            "WORLD  P     DIFFERS FROM WORLD 1\n"
            "2      0.30  cup-1 is at 1.50, 2.00 instead of 1.00, 2.00\n"
            "             cup-2 is present at 3.00, 4.00\n"
            "3      0.05  cup-1 is absent (there: at 1.00, 2.00)\n"
            "4      0.04  cup-1 is of another class: mug at 1.00, 2.00\n"
            "newest frame 2023-11-14 22:13:20 UTC\n");
}

TEST_F(Text, Status) {
  const Json answer = Json::parse(R"({"version": "0.1.0", "ready": true,
    "utime": 1700000000000000, "uptime_s": 754.2,
    "frames": {"accepted": 1200, "repeated": 3, "refused": 2, "overrun": 7, "late": 0, "lost": 0},
    "queue": {"frames": 4000, "capacity": 4096, "overloaded": true, "overloaded_s": 12.3},
    "objects": 5, "anchors": 7, "expected_count": 4.93, "hypotheses": 12, "clusters": 3,
    "update_us": {"median": 310, "p99": 1200, "max": 4100},
    "log": {"directory": "anchord-data", "frames": 1200, "bytes": 1234567},
    "lcm": {"url": "udpm://239.255.76.67:7667?ttl=0", "frames": 1200, "refused": 0,
            "published": 1199, "restarts": 1, "dropped": 0, "dropped_by_kernel": 5},
    "verifications": {"queued": 2, "issued": 1},
    "http": {"address": "127.0.0.1:7780", "connections": 2, "requests": 55, "refused": 0}})");
  EXPECT_EQ(status_text(answer, "robot:7780", {}),
            "daemon        anchord 0.1.0 at robot:7780, ready\n"
            "up for        13 min\n"
            "newest frame  2023-11-14 22:13:20 UTC\n"
            "frames        1200 accepted, 3 repeated, 2 refused, 7 overrun, 0 late, 0 lost\n"
            "queue         4000 of 4096 frames, overloaded for 12 s\n"
            "belief        5 objects, 7 anchors, 4.93 expected, 12 hypotheses, 3 clusters\n"
            "update        median 0.31 ms, p99 1.2 ms, max 4.1 ms\n"
            "log           anchord-data, 1200 frames, 1.2 MB\n"
            "tasks         2 queued, 1 issued\n"
            "lcm           udpm://239.255.76.67:7667?ttl=0, 1200 frames, 0 refused, 1199 "
            "published, 1 restarts, "
            "0 dropped, 5 dropped by the kernel\n"
            "http          127.0.0.1:7780, 2 connections, 55 requests, 0 refused\n");
}

TEST_F(Text, AnswersOfAnotherShapeAreNoAccident) {
  for (const char* other : {"null", "[]", "3", R"({"answers": 3, "objects": {"a": 1}})",
                            R"({"worlds": [1, "x"], "answers": [null], "objects": [[]]})"}) {
    const Json answer = Json::parse(other);
    EXPECT_FALSE(where_text(answer, {}).empty());
    EXPECT_FALSE(objects_text(answer, {}).empty());
    EXPECT_FALSE(count_text(answer, {}).empty());
    EXPECT_FALSE(hypotheses_text(answer, {}).empty());
    EXPECT_FALSE(status_text(answer, "a:1", {}).empty());
  }
}

}  // namespace
}  // namespace anchord
