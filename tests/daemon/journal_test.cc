#include "daemon/journal.h"

#include <gtest/gtest.h>

#include <future>
#include <nlohmann/json.hpp>

#include "knowledge/sqlite.h"
#include "lcmtypes/codec.h"
#include "tests/daemon/answers.h"
#include "tests/daemon/scene.h"

namespace anchord {
namespace {

class JournalTest : public ::testing::Test {
 protected:
  /// A journal over the test's folder that has restored what is there, not started yet.
  std::unique_ptr<Journal> make(std::int64_t max_bytes = 0) {
    auto log = FrameLog::open(folder_ / "data", max_bytes);
    if (!log) {
      ADD_FAILURE() << log.error().text();
      return nullptr;
    }
    Journal::Hooks hooks;
    hooks.applied = [this](const auto&) { ++applied_; };
    hooks.refused = [this](const Submission&, const Frame* frame, const Error&) {
      refused_utimes_.push_back(frame ? frame->utime : 0);
    };
    auto journal = std::make_unique<Journal>(World(scene()), *std::move(log), statistics_, times_,
                                             std::move(hooks));
    const auto restored = journal->restore(std::atomic<bool>{false});
    EXPECT_TRUE(restored.ok());
    return journal;
  }
  std::unique_ptr<Journal> started(std::int64_t max_bytes = 0) {
    auto journal = make(max_bytes);
    if (journal) journal->start();
    return journal;
  }

  static std::future<Result<Receipt>> hand_in(Journal& journal, std::vector<Frame> frames,
                                              bool array = false) {
    auto promise = std::make_shared<std::promise<Result<Receipt>>>();
    auto receipt = promise->get_future();
    EXPECT_TRUE(journal.submit({std::move(frames), "test", array, [promise](Result<Receipt> r) {
                                  promise->set_value(std::move(r));
                                }}));
    return receipt;
  }
  static Result<Receipt> apply(Journal& journal, std::vector<Frame> frames) {
    const bool array = frames.size() > 1;
    return hand_in(journal, std::move(frames), array).get();
  }

  /// What another process sees in the database: only what has been committed.
  std::int64_t committed() {
    auto database = sqlite::Database::open(folder_ / "data/anchord.db");
    auto count = database->read_integer("SELECT count(*) FROM frames");
    EXPECT_TRUE(count.ok());
    return count ? *count : -1;
  }

  TestFolder folder_;
  Statistics statistics_;
  UpdateTimes times_;
  std::atomic<int> applied_{0};
  std::vector<Utime> refused_utimes_;  // of the journal's thread; read once it has ended
};

TEST_F(JournalTest, AcknowledgesWhatIsCommitted) {
  auto journal = started();
  ASSERT_TRUE(journal);
  for (int i = 1; i <= 5; ++i) {
    std::promise<std::int64_t> seen;
    journal->submit({{frame_number(i)}, "test", false, [&](const Result<Receipt>& receipt) {
                       EXPECT_TRUE(receipt.ok());
                       seen.set_value(committed());
                     }});
    EXPECT_EQ(seen.get_future().get(), i);
  }
  EXPECT_EQ(applied_, 5);
  EXPECT_EQ(statistics_.accepted, 5u);
  EXPECT_EQ(times_.summary().count, 5u);
}

TEST_F(JournalTest, NobodyWaitsAndItIsCommittedAllTheSame) {
  auto journal = started();
  ASSERT_TRUE(journal);
  ASSERT_TRUE(journal->submit({{frame_number(1)}, "test", false, {}}));
  while (statistics_.accepted == 0) std::this_thread::yield();
  EXPECT_EQ(committed(), 1);
}

TEST_F(JournalTest, SentAgainIsAcknowledgedAndNotApplied) {
  auto journal = started();
  ASSERT_TRUE(journal);
  ASSERT_TRUE(apply(*journal, {frame_number(1)}).ok());
  ASSERT_TRUE(apply(*journal, {frame_number(2)}).ok());
  const auto belief = journal->snapshot().belief;
  for (const int number : {1, 2}) {
    const auto again = apply(*journal, {frame_number(number)});
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(again->accepted, 0u);
    EXPECT_EQ(again->repeated, 1u);
  }
  EXPECT_EQ(statistics_.repeated, 2u);
  EXPECT_EQ(journal->snapshot().belief, belief);
  EXPECT_EQ(committed(), 2);
}

TEST_F(JournalTest, AgainWhileTheFirstIsNotYetDurable) {
  auto journal = make();
  ASSERT_TRUE(journal);
  std::promise<std::int64_t> seen;
  journal->submit({{frame_number(1)}, "test", false, {}});
  journal->submit({{frame_number(1)}, "test", false, [&](const Result<Receipt>& receipt) {
                     EXPECT_TRUE(receipt.ok() && receipt->repeated == 1);
                     seen.set_value(committed());
                   }});
  journal->start();
  EXPECT_EQ(seen.get_future().get(), 1);
}

TEST_F(JournalTest, OtherContentOrAnOlderTimeIsAConflict) {
  auto journal = started();
  ASSERT_TRUE(journal);
  ASSERT_TRUE(apply(*journal, {frame_number(1)}).ok());
  ASSERT_TRUE(apply(*journal, {frame_number(3)}).ok());
  const auto belief = journal->snapshot().belief;
  Frame other = frame_number(3);
  other.detections.pop_back();
  for (const Frame& wrong : {other, frame_number(2)}) {
    const auto refused = apply(*journal, {wrong});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
    EXPECT_EQ(refused.error().field, "utime");
    // At the same time, or before it: what is told differs.
    EXPECT_EQ(refused.error().message.find("another frame") != std::string::npos,
              wrong.utime == other.utime)
        << refused.error().message;
  }
  EXPECT_EQ(journal->snapshot().belief, belief);
  EXPECT_EQ(statistics_.refused, 2u);
  journal.reset();
  EXPECT_EQ(refused_utimes_, (std::vector<Utime>{other.utime, frame_number(2).utime}));
}

TEST_F(JournalTest, OneFrameTwiceInAnArray) {
  auto journal = started();
  ASSERT_TRUE(journal);
  const auto receipt = apply(*journal, {frame_number(1), frame_number(1), frame_number(2)});
  ASSERT_TRUE(receipt.ok()) << receipt.error().text();
  EXPECT_EQ(receipt->accepted, 2u);
  EXPECT_EQ(receipt->repeated, 1u);
  Frame other = frame_number(3);
  other.detections.clear();
  const auto refused = apply(*journal, {frame_number(3), other});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().field, "[1].utime");
  EXPECT_EQ(committed(), 2);
}

TEST_F(JournalTest, AnArrayIsTakenWholeOrNotAtAll) {
  auto journal = started();
  ASSERT_TRUE(journal);
  ASSERT_TRUE(apply(*journal, {frame_number(1)}).ok());
  const auto belief = journal->snapshot().belief;
  Frame bad = frame_number(3);
  std::get<CartesianMeasurement>(bad.detections[1].measurement).covariance[0] = -1;
  const auto refused = apply(*journal, {frame_number(2), bad, frame_number(4)});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().field, "[1].detections[1].covariance");
  EXPECT_EQ(journal->snapshot().belief, belief);
  EXPECT_EQ(applied_, 1) << "nobody may be shown half of it";
  EXPECT_EQ(statistics_.refused, 3u);
  EXPECT_TRUE(apply(*journal, {frame_number(2), frame_number(4)}).ok());
  EXPECT_EQ(committed(), 3);
  journal.reset();
  EXPECT_EQ(refused_utimes_, std::vector<Utime>{bad.utime});
}

TEST_F(JournalTest, AFullDiskRefusesAndTheBeliefGoesBack) {
  std::string kept;
  int durable = 0;
  {
    auto journal = started(128 * 1024);  // a few hundred frames of about 400 bytes
    ASSERT_TRUE(journal);
    Result<Receipt> receipt = Receipt{};
    while (receipt && durable < 10'000) {
      kept = answers(journal->snapshot());
      // By twos: the second may find the disk full when the first did not.
      const int next = 2 * durable;
      receipt = apply(*journal, {frame_number(next), frame_number(next + 1)});
      if (receipt) ++durable;
    }
    ASSERT_FALSE(receipt.ok());
    EXPECT_EQ(receipt.error().code, ErrorCode::kStorage);
    EXPECT_EQ(answers(journal->snapshot()), kept);
    EXPECT_EQ(journal->logged_frames(), 2 * durable);
    EXPECT_EQ(committed(), 2 * durable);
    EXPECT_EQ(statistics_.commit_failures, 1u);
    EXPECT_EQ(statistics_.accepted, 2u * durable);
    EXPECT_EQ(statistics_.refused, 2u);
    EXPECT_EQ(statistics_.unstored, 2u);
    const auto again = apply(*journal, {frame_number(0)});
    EXPECT_TRUE(again.ok() && again->repeated == 1) << "what is durable stays";
  }
  auto journal = started();  // the disk has room again
  ASSERT_TRUE(journal);
  EXPECT_EQ(answers(journal->snapshot()), kept);
  EXPECT_TRUE(apply(*journal, {frame_number(2 * durable)}).ok());
}

TEST_F(JournalTest, ARollbackRefusesAllOfTheBatch) {
  auto journal = make(128 * 1024);
  ASSERT_TRUE(journal);
  // All of it waits before the start, so much of it is in one batch when the disk is full.
  std::vector<std::future<Result<Receipt>>> receipts;
  for (int i = 0; i < 1000; ++i) receipts.push_back(hand_in(*journal, {frame_number(i)}));
  journal->start();
  std::size_t accepted = 0;
  for (auto& receipt : receipts) accepted += receipt.get().ok() ? 1 : 0;
  EXPECT_LT(accepted, 1000u);
  EXPECT_EQ(statistics_.accepted, accepted);
  EXPECT_EQ(statistics_.refused, 1000 - accepted);
  EXPECT_EQ(committed(), static_cast<std::int64_t>(accepted));
  const std::string kept = answers(journal->snapshot());
  journal.reset();
  EXPECT_EQ(answers(make()->snapshot()), kept);
}

TEST_F(JournalTest, RestoresTheBeliefToTheByte) {
  std::string before;
  {
    auto journal = started();
    ASSERT_TRUE(journal);
    for (int i = 1; i <= 40; ++i) ASSERT_TRUE(apply(*journal, {frame_number(i)}).ok());
    // Of another sensor, behind the newest by less than max_lateness: put in its place.
    ASSERT_TRUE(apply(*journal, {frame_number(35, "laser")}).ok());
    EXPECT_EQ(statistics_.late, 1u);
    before = answers(journal->snapshot());
  }
  statistics_.late = 0;
  auto journal = started();
  ASSERT_TRUE(journal);
  EXPECT_EQ(answers(journal->snapshot()), before);
  EXPECT_EQ(journal->logged_frames(), 41);
  ASSERT_TRUE(apply(*journal, {frame_number(41)}).ok());
  EXPECT_EQ(statistics_.late, 0u) << "counted since the start";
}

TEST_F(JournalTest, APositionInThePlaneIsNoneInSpace) {
  auto journal = started();
  Frame flat = frame_number(1);
  std::get<CartesianMeasurement>(flat.detections[1].measurement) = {{1, 2}, {1, 0, 0, 1}};
  const auto receipt = apply(*journal, {flat});
  ASSERT_FALSE(receipt.ok());
  EXPECT_EQ(receipt.error().field, "detections[1].position");
  EXPECT_EQ(committed(), 0);
  std::get<CartesianMeasurement>(flat.detections[1].measurement).covariance.clear();
  EXPECT_FALSE(apply(*journal, {flat}).ok()) << "though the sensor's noise would do";
}

TEST_F(JournalTest, AFrameThatCannotBeFoldedIsNamed) {
  {
    auto journal = started();
    ASSERT_TRUE(journal && apply(*journal, {frame_number(1), frame_number(2)}).ok());
  }
  // A configuration without colors, as if the log had been written under it.
  auto without = nlohmann::json::parse(kScene);
  without["attributes"].erase("color");
  const auto configuration = parse_configuration(without.dump());
  {
    auto log = FrameLog::open(folder_ / "data");
    ASSERT_TRUE((*log)->put_configuration({1, configuration.knowledge().text}).ok());
    ASSERT_TRUE((*log)->commit().ok());
  }
  auto log = FrameLog::open(folder_ / "data");
  ASSERT_TRUE(log.ok());
  Journal journal(World(configuration.knowledge()), *std::move(log), statistics_, times_, {});
  const auto restored = journal.restore(std::atomic<bool>{false});
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(restored.error().field, "detections[0].attributes.color");
  EXPECT_NE(restored.error().message.find("frame 1 of the log"), std::string::npos);
}

TEST_F(JournalTest, ARestoreCanBeCancelled) {
  {
    auto journal = started();
    ASSERT_TRUE(journal && apply(*journal, {frame_number(1), frame_number(2)}).ok());
  }
  auto log = FrameLog::open(folder_ / "data");
  ASSERT_TRUE(log.ok());
  int alive = 0;
  Journal journal(World(scene()), *std::move(log), statistics_, times_, {{}, {}, [&] { ++alive; }});
  EXPECT_TRUE(journal.restore(std::atomic<bool>{true}).ok());
  EXPECT_EQ(alive, 1);
}

TEST_F(JournalTest, TooManyMayNotWait) {
  auto journal = make();
  ASSERT_TRUE(journal);
  const std::vector<Frame> half(Journal::kQueue / 2, frame_number(1));
  auto first = hand_in(*journal, half, true), second = hand_in(*journal, half, true);
  bool called = false;
  EXPECT_FALSE(
      journal->submit({{frame_number(2)}, "test", false, [&](const auto&) { called = true; }}));
  EXPECT_EQ(journal->waiting().frames, Journal::kQueue);
  EXPECT_TRUE(journal->waiting().overloaded);
  journal->start();
  EXPECT_EQ(first.get()->repeated, half.size() - 1);
  EXPECT_EQ(second.get()->repeated, half.size());
  EXPECT_FALSE(called);
  EXPECT_TRUE(apply(*journal, {frame_number(2)}).ok()) << "there is room again";
  EXPECT_FALSE(journal->waiting().overloaded);
}

TEST_F(JournalTest, TheEndAnswersEverything) {
  std::vector<std::future<Result<Receipt>>> receipts;
  auto journal = make();
  ASSERT_TRUE(journal);
  for (int i = 1; i <= 50; ++i) receipts.push_back(hand_in(*journal, {frame_number(i)}));
  journal->start();
  journal.reset();
  std::int64_t accepted = 0;
  for (auto& receipt : receipts) accepted += receipt.get().ok() ? 1 : 0;
  EXPECT_EQ(committed(), accepted) << "what is left over after kEnding is refused, not forgotten";
  EXPECT_EQ(statistics_.accepted + statistics_.refused, 50u);
}

}  // namespace
}  // namespace anchord
