// What was believed at earlier times is what a replay of the log up to then gives, to the byte.

#include "daemon/past.h"

#include <gtest/gtest.h>

#include <future>
#include <nlohmann/json.hpp>

#include "anchoring/reconfigure.h"
#include "daemon/journal.h"
#include "knowledge/sqlite.h"
#include "tests/daemon/answers.h"
#include "tests/daemon/scene.h"

namespace anchord {
namespace {

/// kScene with what `change` makes of it.
template <typename Change>
Knowledge scene_with(Change change) {
  auto document = nlohmann::json::parse(kScene);
  change(document);
  const auto configuration = parse_configuration(document.dump());
  EXPECT_TRUE(configuration.ok());
  return configuration.knowledge();
}

Event grasp(int number) {
  Event event;
  event.kind = Event::Kind::kGrasped;
  event.utime = frame_number(number).utime;
  event.robot = "amigo";
  event.object = "cup-1";
  event.position = {1, 1, 1};
  return event;
}

class PastTest : public ::testing::Test {
 protected:
  void start(const Knowledge& knowledge = scene(), bool checkpoints = true) {
    journal_.reset();
    auto log = FrameLog::open(folder_ / "data");
    ASSERT_TRUE(log.ok());
    now_.emplace(knowledge);
    std::unique_ptr<Checkpointer> checkpointer;
    if (checkpoints) checkpointer = std::make_unique<Checkpointer>(folder_ / "data", *now_, 0);
    journal_ = std::make_unique<Journal>(*now_, *std::move(log), statistics_, times_,
                                         Journal::Hooks{}, std::move(checkpointer));
    restored_ = journal_->restore(std::atomic<bool>{false});
    if (restored_.ok()) journal_->start();
    past_.emplace(folder_ / "data", *now_);
  }

  bool hand_in(Submission submission) {
    std::promise<bool> done;
    submission.origin = "test";
    submission.done = [&done](Result<Receipt> receipt) { done.set_value(receipt.ok()); };
    EXPECT_TRUE(journal_->submit(std::move(submission)));
    return done.get_future().get();
  }
  bool send(const Frame& frame) {
    const bool taken = hand_in({{frame}, "", false, {}});
    if (taken) replayed_.push_back({frame});
    return taken;
  }
  bool tell(const Event& event) {
    Submission submission{{}, "", false, {}};
    submission.events = {event};
    const bool taken = hand_in(std::move(submission));
    if (taken) replayed_.push_back({event});
    return taken;
  }

  /// All that the log holds up to then, folded by a world of its own.
  std::string replay(Utime until, const Knowledge& knowledge = scene()) {
    World world(knowledge);
    for (const Accepted& one : replayed_) {
      if (const auto* frame = std::get_if<Frame>(&one.what)) {
        if (frame->utime <= until) EXPECT_TRUE(world.apply(*frame).ok());
      } else if (const auto& event = std::get<Event>(one.what); event.utime <= until) {
        EXPECT_TRUE(world.apply(event).ok());
      }
    }
    return answers({world.belief(), world.background()});
  }
  std::string at(Utime utime) {
    const auto then = past_->at(utime, journal_->logged_frames());
    return then ? answers(*then) : then.error().text();
  }

  TestFolder folder_;
  Statistics statistics_;
  UpdateTimes times_;
  std::optional<World> now_;
  std::unique_ptr<Journal> journal_;
  std::optional<Past> past_;
  Status restored_ = Done{};
  std::vector<Accepted> replayed_;
};

TEST_F(PastTest, IsWhatAReplayOfTheLogUpToThenGives) {
  for (const bool checkpoints : {false, true}) {
    start(scene(), checkpoints);
    const int first = checkpoints ? 100 : 1;
    for (int i = first; i < first + 60; ++i) {
      ASSERT_TRUE(send(frame_number(i)));
      // Of another sensor, late, in its place.
      if (i % 7 == 0) ASSERT_TRUE(send(frame_number(i - 5, "eye")));
    }
    for (const int i : {first, first + 10, first + 12, first + 11, first + 59, first + 30})
      for (const Utime beside : {0, 1, -1}) {
        const Utime utime = frame_number(i).utime + beside;
        EXPECT_EQ(at(utime), replay(utime)) << i << " " << beside;
      }
  }
  EXPECT_EQ(at(kEarliestUtime), answers({now_->belief(), now_->background()}))
      << "before the first frame nothing is believed";
}

TEST_F(PastTest, HoldsEventsAsTheyWereTaken) {
  start();
  for (int i = 1; i < 20; ++i) ASSERT_TRUE(send(frame_number(i)));
  ASSERT_TRUE(tell(grasp(15)));
  for (int i = 20; i < 40; ++i) ASSERT_TRUE(send(frame_number(i)));
  for (const int i : {14, 15, 16, 30})
    EXPECT_EQ(at(frame_number(i).utime), replay(frame_number(i).utime)) << i;
}

TEST_F(PastTest, GoesAlongATimeLineThatGrows) {
  start();
  for (int i = 1; i < 30; ++i) {
    ASSERT_TRUE(send(frame_number(i)));
    const Utime utime = frame_number(i - i % 3).utime;
    ASSERT_EQ(at(utime), replay(utime)) << i;
    // Late, and before what has been asked for already.
    if (i > 6 && i % 5 == 0) {
      ASSERT_TRUE(send(frame_number(i - 4, "eye")));
      ASSERT_EQ(at(utime), replay(utime)) << i;
    }
  }
}

TEST_F(PastTest, EachConfigurationHoldsForItsTime) {
  const Knowledge careless = scene_with([](auto& c) {
    c["classes"]["default"]["detection_probability"] = 0.5;
    c["attributes"]["color"]["symbols"].push_back("green");
  });
  start();
  for (int i = 1; i < 20; ++i) ASSERT_TRUE(send(frame_number(i)));
  const std::string before = answers(journal_->snapshot());
  start(careless);
  ASSERT_TRUE(restored_.ok());
  EXPECT_EQ(journal_->snapshot().background->knowledge.fingerprint, careless.fingerprint);
  for (int i = 20; i < 40; ++i) ASSERT_TRUE(send(frame_number(i)));
  const Utime change = frame_number(19).utime;
  EXPECT_EQ(at(change), before);
  EXPECT_EQ(at(frame_number(9).utime), replay(frame_number(9).utime));
  // After it, as a world that goes on from there.
  World world(scene());
  for (int i = 1; i < 20; ++i) ASSERT_TRUE(world.apply(frame_number(i)).ok());
  auto changed = reconfigured(world, World(careless));
  ASSERT_TRUE(changed.ok());
  for (int i = 20; i < 30; ++i) ASSERT_TRUE(changed->apply(frame_number(i)).ok());
  EXPECT_EQ(at(frame_number(29).utime), answers({changed->belief(), changed->background()}));

  const std::string last = answers(journal_->snapshot());
  for (const bool checkpoints : {true, false}) {
    if (!checkpoints) std::filesystem::remove(folder_ / "data/anchord.db-checkpoints");
    start(careless, checkpoints);
    EXPECT_EQ(answers(journal_->snapshot()), last) << "a start folds each under its own";
  }
}

TEST_F(PastTest, AConfigurationWithoutAFrameLeavesNothing) {
  start();
  for (int i = 1; i < 5; ++i) ASSERT_TRUE(send(frame_number(i)));
  const std::string before = answers(journal_->snapshot());
  start(scene_with([](auto& c) { c["classes"]["default"]["detection_probability"] = 0.5; }));
  EXPECT_EQ((*past_->log())->configurations()->size(), 1u);
  start();
  EXPECT_EQ(answers(journal_->snapshot()), before);
}

TEST_F(PastTest, WhatIsInUseCannotBeTakenAway) {
  start();
  for (int i = 1; i < 5; ++i) ASSERT_TRUE(send(frame_number(i)));
  start(scene_with([](auto& c) { c["attributes"]["color"]["symbols"] = {"blue"}; }));
  ASSERT_FALSE(restored_.ok());
  EXPECT_EQ(restored_.error().code, ErrorCode::kConflict);
  EXPECT_EQ(restored_.error().field, "attributes.color.symbols");
  EXPECT_NE(restored_.error().message.find("red"), std::string::npos) << restored_.error().text();
}

TEST_F(PastTest, AnOlderLogIsTakenAsWrittenUnderWhatRuns) {
  start();
  for (int i = 1; i < 20; ++i) ASSERT_TRUE(send(frame_number(i)));
  const std::string before = answers(journal_->snapshot());
  journal_.reset();
  auto database = sqlite::Database::open(folder_ / "data/anchord.db");
  ASSERT_TRUE(database->execute("DELETE FROM configurations").ok());
  start();
  EXPECT_EQ(answers(journal_->snapshot()), before);
  ASSERT_TRUE(send(frame_number(20)));
  EXPECT_EQ((*past_->log())->configurations()->front().first, 1);
}

}  // namespace
}  // namespace anchord
