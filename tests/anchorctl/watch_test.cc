#include "tools/anchorctl/watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "tests/anchorctl/utc.h"
#include "tools/anchorctl/changes.h"
#include "tools/anchorctl/watch_text.h"

namespace anchord {
namespace {

Json objects(std::vector<Json> list) { return {{"utime", kT}, {"objects", std::move(list)}}; }

Json cup(double x, const char* place = "table", const char* kind = "cup") {
  return {{"id", "cup-1"},
          {"p", 0.97},
          {"position", {x, 2}},
          {"place", place},
          {"attributes", {{"class", {{kind, 0.98}}}}},
          {"last_seen", kT}};
}

TEST(Changes, OneLineForEach) {
  use_utc();
  const std::string when = "2023-11-14 22:13:20 UTC  cup-1  ";
  using Lines = std::vector<std::string>;
  Changes changes;
  EXPECT_EQ(changes.update(objects({cup(1)})),
            Lines{when + "appeared: cup, p 0.97, place table, at 1.00, 2.00 m"});
  EXPECT_EQ(changes.update(objects({cup(1)})), Lines{});
  EXPECT_EQ(changes.update(objects({cup(1.06)})), Lines{}) << "not yet far enough";
  EXPECT_EQ(changes.update(objects({cup(1.12)})),
            Lines{when + "moved, place table, at 1.12, 2.00 m"})
      << "from where it was last told to be";
  EXPECT_EQ(changes.update(objects({cup(1.12, "sink")})),
            Lines{when + "place table -> sink, at 1.12, 2.00 m"});
  EXPECT_EQ(changes.update(objects({cup(1.12, "sink", "mug")})), Lines{when + "class cup -> mug"});
  EXPECT_EQ(changes.update(objects({})), Lines{when + "disappeared"});
}

TEST(FrameRate, OverTheLastSeconds) {
  FrameRate rate;
  EXPECT_EQ(rate.per_second(), std::nullopt);
  rate.add(100, 1000);
  EXPECT_EQ(rate.per_second(), std::nullopt);
  rate.add(101, 1030);
  EXPECT_DOUBLE_EQ(rate.per_second().value(), 30);
  for (int s = 2; s <= 20; ++s) rate.add(100 + s, 1030);
  EXPECT_DOUBLE_EQ(rate.per_second().value(), 0) << "what is long ago counts no more";
  rate.add(121, 5);
  EXPECT_EQ(rate.per_second(), std::nullopt) << "a restart";
}

TEST(WatchText, TableHasSpeedWhereSomethingMoves) {
  use_utc();
  Json moving = cup(1);
  moving["velocity"] = {0.3, 0.4};
  EXPECT_EQ(watch_table(objects({moving}), {}),
            "OBJECT  P     CLASS     PLACE  POSITION [m]  SPEED     SEEN AGO\n"
            "cup-1   0.97  cup 0.98  table  1.00, 2.00    0.50 m/s  0 s\n");
  EXPECT_EQ(watch_table(objects({cup(1)}), {}),
            "OBJECT  P     CLASS     PLACE  POSITION [m]  SEEN AGO\n"
            "cup-1   0.97  cup 0.98  table  1.00, 2.00    0 s\n");
  EXPECT_EQ(watch_table(objects({}), {}), "no object\n");
}

TEST(WatchText, TableFitsItsHeight) {
  const Json answer = objects({cup(1), cup(2), cup(3), cup(4)});
  const auto lines = [&](int height) {
    const std::string table = watch_table(answer, {false, 0, height});
    return std::count(table.begin(), table.end(), '\n');
  };
  EXPECT_EQ(lines(0), 5);
  EXPECT_EQ(lines(5), 5);
  EXPECT_EQ(lines(4), 4);
  const std::string table = watch_table(answer, {false, 0, 4});
  EXPECT_TRUE(table.ends_with("and 2 more\n")) << table;
}

TEST(WatchText, StatusLine) {
  use_utc();
  const Json status{
      {"utime", kT}, {"hypotheses", 12}, {"clusters", 3}, {"frames", {{"refused", 2}}}};
  EXPECT_EQ(watch_status_line(status, "a:1", 29.84),
            "a:1  22:13:20  29.8 frames/s  12 hypotheses in 3 clusters  "
            "2 refused");
}

/// A daemon with prepared answers and a clock that only wait() moves.
struct Fake {
  std::deque<Result<Json>> answers;
  double now_s = 0;
  std::string printed, notes;

  WatchSeams seams() {
    return {[this](const std::string& target) -> Result<Answer> {
              if (target == "/v1/status") return Answer{"", {{"frames", {{"refused", 0}}}}};
              if (answers.empty()) return Error{ErrorCode::kUnavailable, "", "gone"};
              auto next = answers.front();
              answers.pop_front();
              if (!next) return next.error();
              return Answer{next->dump(), *next};
            },
            [this] { return now_s; },
            [this](double s) {
              now_s += s;
              return true;
            },
            [] { return Style{}; },
            [this](const std::string& text) {
              printed += text;
              return true;
            },
            [this](const std::string& line) { notes += line + "\n"; }};
  }
};

WatchSettings settings(WatchSettings::Output output, double for_s) {
  return {"/v1/objects", "a:1", output, 1, for_s};
}

const Error kAway{ErrorCode::kUnavailable, "", "nobody there"};

TEST(Watch, WaitsForTheDaemonAndComesBack) {
  use_utc();
  Fake fake;
  fake.answers = {objects({cup(1)}), kAway, kAway, objects({cup(1)}), objects({})};
  EXPECT_TRUE(watch(settings(WatchSettings::Output::kChanges, 4), fake.seams()).ok());
  EXPECT_EQ(fake.notes,
            "waiting for the daemon at a:1: nobody there\n"
            "the daemon at a:1 answers\n");
  EXPECT_EQ(fake.printed,
            "2023-11-14 22:13:20 UTC  cup-1  appeared: cup, p 0.97, place table, at 1.00, 2.00 m\n"
            "2023-11-14 22:13:20 UTC  cup-1  disappeared\n");
}

TEST(Watch, RedrawsTheScreenAndKeepsTheTableWhileItWaits) {
  use_utc();
  Fake fake;
  fake.answers = {objects({cup(1)}), kAway};
  EXPECT_TRUE(watch(settings(WatchSettings::Output::kScreen, 1), fake.seams()).ok());
  const std::string second = fake.printed.substr(fake.printed.rfind("\x1b[H"));
  EXPECT_EQ(second,
            "\x1b[Hwaiting for the daemon at a:1\x1b[K\n\x1b[K\n"
            "OBJECT  P     CLASS     PLACE  POSITION [m]  SEEN AGO\x1b[K\n"
            "cup-1   0.97  cup 0.98  table  1.00, 2.00    0 s\x1b[K\n\x1b[J");
  EXPECT_TRUE(fake.notes.empty());
}

TEST(Watch, JsonOnlyWhenItDiffers) {
  Fake fake;
  fake.answers = {objects({}), objects({}), objects({cup(1)})};
  EXPECT_TRUE(watch(settings(WatchSettings::Output::kJson, 2), fake.seams()).ok());
  EXPECT_EQ(fake.printed, objects({}).dump() + "\n" + objects({cup(1)}).dump() + "\n");
}

TEST(Watch, FailsIfNobodyEverAnswered) {
  Fake fake;
  const auto watched = watch(settings(WatchSettings::Output::kChanges, 3), fake.seams());
  ASSERT_FALSE(watched.ok());
  EXPECT_EQ(watched.error().message, "gone");
  EXPECT_DOUBLE_EQ(fake.now_s, 3);
}

TEST(Watch, ARefusedQuestionIsNotAskedAgain) {
  Fake fake;
  fake.answers = {invalid("class", "unknown"), objects({})};
  const auto watched = watch(settings(WatchSettings::Output::kChanges, 3), fake.seams());
  ASSERT_FALSE(watched.ok());
  EXPECT_EQ(watched.error().field, "class");
  EXPECT_EQ(fake.answers.size(), 1u);
}

}  // namespace
}  // namespace anchord
