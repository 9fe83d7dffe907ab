// The journal over a disk that fails: what it acknowledged is what a restart believes.

#include <gtest/gtest.h>

#include <future>

#include "daemon/journal.h"
#include "tests/daemon/answers.h"
#include "tests/daemon/scene.h"
#include "tests/knowledge/fault_vfs.h"

namespace anchord {
namespace {

using Fault = FaultVfs::Fault;

class JournalFaultsTest : public ::testing::Test {
 protected:
  std::unique_ptr<Journal> start(const std::string& directory) {
    auto log = FrameLog::open(directory);
    if (!log) return nullptr;
    Journal::Hooks hooks;
    hooks.refused = [this](const Submission&, const Frame*, const Error& why) {
      refusals_.push_back(why.text());
    };
    auto journal = std::make_unique<Journal>(World(scene()), *std::move(log), statistics_, times_,
                                             std::move(hooks));
    if (!journal->restore(std::atomic<bool>{false})) return nullptr;
    journal->start();
    return journal;
  }
  static Result<Receipt> send(Journal& journal, int number) {
    std::promise<Result<Receipt>> promise;
    EXPECT_TRUE(journal.submit({{frame_number(number)}, "test", false, [&](Result<Receipt> r) {
                                  promise.set_value(std::move(r));
                                }}));
    return promise.get_future().get();
  }

  TestFolder folder_;
  Statistics statistics_;
  UpdateTimes times_;
  std::vector<std::string> refusals_;  // of the journal's thread; read once it has ended
};

TEST_F(JournalFaultsTest, AFullDiskRefusesUntilThereIsRoom) {
  FaultVfs disk;
  std::string after;
  {
    auto journal = start(folder_ / "data");
    ASSERT_TRUE(journal);
    for (int i = 1; i <= 5; ++i) ASSERT_TRUE(send(*journal, i).ok());
    const std::string before = answers(journal->snapshot());
    disk.set_room(0);
    for (int i = 6; i <= 8; ++i) {
      const auto refused = send(*journal, i);
      ASSERT_FALSE(refused.ok());
      EXPECT_EQ(refused.error().code, ErrorCode::kStorage);
    }
    EXPECT_EQ(answers(journal->snapshot()), before);
    const auto again = send(*journal, 5);
    EXPECT_TRUE(again.ok() && again->repeated == 1) << "what is there can be acknowledged";
    disk.set_room(INT64_MAX);
    for (int i = 7; i <= 9; ++i) EXPECT_TRUE(send(*journal, i).ok());
    after = answers(journal->snapshot());
  }
  EXPECT_EQ(statistics_.unstored, 3u);
  EXPECT_EQ(statistics_.refused, 3u);
  EXPECT_EQ(statistics_.accepted, 8u);
  ASSERT_EQ(refusals_.size(), 3u);
  EXPECT_NE(refusals_[0].find("full"), std::string::npos) << refusals_[0];
  const auto journal = start(folder_ / "data");
  ASSERT_TRUE(journal);
  EXPECT_EQ(answers(journal->snapshot()), after);
}

TEST_F(JournalFaultsTest, AFaultAtAnyPointIsRefusedOrHasNoEffect) {
  std::int64_t operations = 100;
  for (std::int64_t at = 1; at <= operations; ++at) {
    SCOPED_TRACE(testing::Message() << "operation " << at);
    FaultVfs disk;
    const std::string directory = folder_ / std::to_string(at);
    std::string believed;
    std::vector<int> sent;
    {
      auto journal = start(directory);
      ASSERT_TRUE(journal);
      disk.fail(at, at % 2 == 0 ? Fault::kIo : Fault::kNoSpace, false);
      for (int i = 1; i <= 4; ++i) {
        auto receipt = send(*journal, i);
        if (!receipt) {
          EXPECT_EQ(receipt.error().code, ErrorCode::kStorage) << receipt.error().text();
          receipt = send(*journal, i);
        }
        EXPECT_TRUE(receipt.ok()) << receipt.error().text();
      }
      believed = answers(journal->snapshot());
      operations = std::min(operations, disk.operations());
    }
    disk.heal();
    const auto journal = start(directory);
    ASSERT_TRUE(journal);
    EXPECT_EQ(journal->logged_frames(), 4);
    EXPECT_EQ(answers(journal->snapshot()), believed);
  }
}

}  // namespace
}  // namespace anchord
