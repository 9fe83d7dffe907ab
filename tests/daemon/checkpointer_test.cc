// A start goes on from a checkpoint, where one fits, and believes what the log says.

#include "daemon/checkpointer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/journal.h"
#include "knowledge/sqlite.h"
#include "tests/daemon/answers.h"
#include "tests/daemon/scene.h"

namespace anchord {
namespace {

constexpr double kEachBatch = 0;

class CheckpointerTest : public ::testing::Test {
 protected:
  std::unique_ptr<Journal> restored(const Knowledge& knowledge = scene()) {
    auto log = FrameLog::open(folder_ / "data");
    EXPECT_TRUE(log.ok());
    World world(knowledge);
    auto checkpointer = std::make_unique<Checkpointer>(folder_ / "data", world, kEachBatch);
    Journal::Hooks hooks;
    hooks.alive = [this] { ++folded_; };
    auto journal = std::make_unique<Journal>(std::move(world), *std::move(log), statistics_, times_,
                                             std::move(hooks), std::move(checkpointer));
    folded_ = 0;
    EXPECT_TRUE(journal->restore(std::atomic<bool>{false}).ok());
    at_start_ = folded_;
    return journal;
  }

  /// Runs a journal for frames of two sensors, until a checkpoint holds at least `least` of the
  /// log.
  void live(int first, int frames, std::int64_t least) {
    auto journal = restored();
    journal->start();
    const auto hand_in = [&](Frame frame) {
      std::promise<bool> done;
      ASSERT_TRUE(journal->submit({{std::move(frame)}, "test", false, [&done](Result<Receipt> r) {
                                     done.set_value(r.ok());
                                   }}));
      EXPECT_TRUE(done.get_future().get());
    };
    for (int i = first; i < first + frames; ++i) hand_in(frame_number(i, i % 3 ? "kinect" : "eye"));
    // What is written meanwhile may be of an earlier batch.
    for (int i = first + frames; journal->checkpoint() < least && i < first + frames + 500; ++i) {
      hand_in(frame_number(i));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_GE(journal->checkpoint(), least);
    logged_ = journal->logged_frames();
    believed_ = answers(journal->snapshot());
  }

  void change_checkpoints(const std::string& sql) {
    auto database = sqlite::Database::open(folder_ / "data/anchord.db-checkpoints");
    ASSERT_TRUE(database->execute(sql).ok());
  }

  TestFolder folder_;
  Statistics statistics_;
  UpdateTimes times_;
  std::int64_t folded_ = 0, at_start_ = 0, logged_ = 0;
  std::string believed_;
};

TEST_F(CheckpointerTest, AStartFoldsOnlyWhatCameAfter) {
  live(1, 30, 20);
  const auto journal = restored();
  EXPECT_GE(journal->checkpoint(), 20);
  EXPECT_EQ(at_start_, logged_ - journal->resumed_frames());
  EXPECT_EQ(journal->logged_frames(), logged_);
  EXPECT_EQ(answers(journal->snapshot()), believed_);
}

TEST_F(CheckpointerTest, ItGoesOnAsIfItHadNeverStopped) {
  live(1, 20, 10);
  live(1000, 20, 30);
  const std::string believed = believed_;
  change_checkpoints("DELETE FROM checkpoints");
  const auto journal = restored();
  EXPECT_EQ(at_start_, logged_) << "all of it is folded";
  EXPECT_EQ(answers(journal->snapshot()), believed);
}

TEST_F(CheckpointerTest, AStartThatFoldsLeavesOneForTheNext) {
  live(1, 20, 10);
  change_checkpoints("DELETE FROM checkpoints");
  restored();  // its end waits for what is being written
  restored();
  EXPECT_LT(at_start_, logged_);
}

TEST_F(CheckpointerTest, AnotherConfigurationGoesOnFromIt) {
  live(1, 20, 10);
  auto other = nlohmann::json::parse(kScene);
  other["classes"]["default"]["detection_probability"] = 0.8;
  const auto journal = restored(parse_configuration(other.dump()).knowledge());
  EXPECT_GT(journal->resumed_frames(), 0);
  EXPECT_EQ(at_start_, logged_ - journal->resumed_frames());
}

TEST_F(CheckpointerTest, WhatDoesNotFitTheLogOrIsDamagedIsLeftOut) {
  live(1, 20, 10);
  for (const char* change :
       {"frame_checksum = frame_checksum + 1", "bytes = zeroblob(length(bytes))"}) {
    change_checkpoints(std::string("UPDATE checkpoints SET ") + change);
    const auto journal = restored();
    EXPECT_EQ(journal->resumed_frames(), 0) << change;
    EXPECT_EQ(at_start_, logged_) << change;
    EXPECT_EQ(answers(journal->snapshot()), believed_) << change;
  }
}

}  // namespace
}  // namespace anchord
