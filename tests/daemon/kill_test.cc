// Kills at random moments under load: nothing acknowledged is lost, and the belief is the log's.
// ANCHORD_KILLS says how many, ANCHORD_KILLS_SEED which moments.

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <random>

#include "anchoring/world.h"
#include "knowledge/frame_log.h"
#include "lcmtypes/checked_decode.h"
#include "tests/daemon/answers.h"
#include "tests/daemon/load.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;

int number_in(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

/// What the log says: folded once more, by nobody who was ever killed.
class Replay {
 public:
  /// Folds what has come since, from a copy: a killed daemon's files are for the next one to find.
  void follow(const TestFolder& folder, const std::string& data) {
    const std::string copy = folder / "copy";
    fs::remove_all(copy);
    fs::create_directory(copy);
    for (const char* file : {"/anchord.db", "/anchord.db-wal", "/anchord.db-mark"})
      if (fs::exists(data + file)) fs::copy_file(data + file, copy + file);
    auto log = FrameLog::open(copy);
    ASSERT_TRUE(log.ok()) << log.error().text();
    const Status read = (*log)->for_each(last_ + 1, [&](const LoggedFrame& logged) {
      const auto message = decode_frame(logged.bytes);
      EXPECT_TRUE(message.ok());
      EXPECT_TRUE(world_.apply(message->frame, logged.work).ok());
      EXPECT_TRUE(frames_.insert({logged.sensor, logged.utime}).second) << "a frame stands twice";
      last_ = logged.sequence;
      return true;
    });
    ASSERT_TRUE(read.ok()) << read.error().text();
  }
  bool has(const std::pair<std::string, Utime>& frame) const { return frames_.contains(frame); }
  std::int64_t frames() const { return last_; }
  /// As belief() asks for it.
  std::string answers() const { return anchord::answers({world_.belief(), world_.background()}); }

 private:
  World world_{scene()};
  std::int64_t last_ = 0;
  std::set<std::pair<std::string, Utime>> frames_;
};

TEST(Kill, AtRandomMomentsUnderLoad) {
  const int kills = number_in("ANCHORD_KILLS", 10);
  // A log of its own for so many, or restoring would take most of the time.
  constexpr int kPerLog = 40;
  std::mt19937 random(static_cast<unsigned>(number_in("ANCHORD_KILLS_SEED", 1)));
  std::size_t acknowledged = 0;
  std::int64_t logged = 0;
  for (int kill = 0; kill < kills && !testing::Test::HasFailure();) {
    TestFolder folder;
    Replay replay;
    std::atomic<int> next{0};
    for (int n = 0; n < kPerLog && kill < kills; ++n, ++kill) {
      SCOPED_TRACE(testing::Message() << "kill " << kill + 1);
      // Every other one leaves a checkpoint wherever it can, for the next one to go on from.
      DaemonProcess::Options options;
      if (n % 2 == 0) options.checkpoint_interval = "0";
      DaemonProcess daemon(folder, options);
      if (random() % 5 == 0) {  // while it starts
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 30'000));
        EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL) << daemon.errors();
        continue;
      }
      ASSERT_TRUE(daemon.ready());
      ASSERT_EQ(belief(daemon.port()), replay.answers());
      ASSERT_EQ(counter(daemon.port(), "/log/frames"), replay.frames());
      Load load(daemon.port(), next);
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 100'000));
      ASSERT_EQ(daemon.end(SIGKILL), -SIGKILL) << daemon.errors();
      load.join();
      ASSERT_NO_FATAL_FAILURE(replay.follow(folder, folder / "data"));
      for (const auto& frame : load.acknowledged())
        EXPECT_TRUE(replay.has(frame)) << frame.first << " " << frame.second << " is lost";
      acknowledged += load.acknowledged().size();
    }
    logged += replay.frames();
    DaemonProcess last(folder);
    ASSERT_TRUE(last.ready());
    ASSERT_EQ(belief(last.port()), replay.answers());
  }
  EXPECT_GT(acknowledged, 0u);
  std::printf("%d kills, %zu frames acknowledged, %lld in the logs\n", kills, acknowledged,
              static_cast<long long>(logged));
}

}  // namespace
}  // namespace anchord
