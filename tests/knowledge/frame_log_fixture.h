#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "knowledge/frame_log.h"
#include "knowledge/sqlite.h"

namespace anchord {

inline constexpr Utime kStart = 1'700'000'000'000'000;

/// Frame number n of one of two sensors; its bytes follow from n, some 300 of them.
inline LoggedFrame frame_number(std::int64_t n) {
  LoggedFrame frame{LoggedFrame::Kind::kFrame,       n, kStart + n * 1000, "amigo",
                    n % 2 == 0 ? "kinect" : "laser", {}};
  for (std::int64_t i = 0; i < 300 + n % 7; ++i)
    frame.bytes.push_back(static_cast<std::uint8_t>(n * 31 + i));
  return frame;
}

class FrameLogTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "frame_log_XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    root_ = name;
    directory_ = root_ + "/data";
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  std::unique_ptr<FrameLog> open(std::int64_t max_bytes = 0) {
    auto log = FrameLog::open(directory_, max_bytes);
    if (!log) {
      ADD_FAILURE() << log.error().text();
      return nullptr;
    }
    return *std::move(log);
  }
  Error refusal() {
    auto log = FrameLog::open(directory_);
    EXPECT_FALSE(log.ok());
    return log.ok() ? Error{} : log.error();
  }
  /// Runs statements on the database behind the log's back.
  void tamper(const std::string& sql) {
    auto database = sqlite::Database::open(directory_ + "/anchord.db");
    ASSERT_TRUE(database.ok());
    ASSERT_TRUE(database->execute(sql).ok());
  }

  std::string root_, directory_;
};

inline std::vector<LoggedFrame> all(FrameLog& log, std::int64_t from = 1) {
  std::vector<LoggedFrame> frames;
  auto read = log.for_each(from, [&](const LoggedFrame& frame) {
    frames.push_back(frame);
    return true;
  });
  EXPECT_TRUE(read.ok());
  return frames;
}

}  // namespace anchord
