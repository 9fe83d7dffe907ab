#include "tools/anchorctl/read_time.h"

#include <gtest/gtest.h>

#include "tests/anchorctl/utc.h"

namespace anchord {
namespace {

constexpr Utime kSecond = 1'000'000, kHour = 3600 * kSecond;
constexpr Utime kMidnight = 1'699'920'000 * kSecond;  // 2023-11-14 00:00 UTC
constexpr Utime kNow = kMidnight + 22 * kHour;

class ReadTime : public ::testing::Test {
 protected:
  void SetUp() override { use_utc(); }
  static Utime at(const std::string& text) {
    const auto time = read_time("--at", text, kNow);
    EXPECT_TRUE(time.ok()) << text;
    return time.ok() ? *time : 0;
  }
};

TEST_F(ReadTime, ReadsWhatPeopleWrite) {
  EXPECT_EQ(at("now"), kNow);
  EXPECT_EQ(at("2023-11-13 18:00"), kMidnight - 6 * kHour);
  EXPECT_EQ(at("2023-11-13 18:00:05"), kMidnight - 6 * kHour + 5 * kSecond);
  EXPECT_EQ(at("2023-11-13"), kMidnight - 24 * kHour);
  EXPECT_EQ(at("18:30"), kMidnight + 18 * kHour + kHour / 2);
  EXPECT_EQ(at("today 08:00"), kMidnight + 8 * kHour);
  EXPECT_EQ(at("yesterday 18:00"), kMidnight - 6 * kHour);
  EXPECT_EQ(at("20 min ago"), kNow - kHour / 3);
  EXPECT_EQ(at("1.5 h ago"), kNow - 3 * kHour / 2);
  EXPECT_EQ(at("2 days ago"), kNow - 48 * kHour);
  EXPECT_EQ(at("1700000000000000"), 1'700'000'000'000'000);
}

TEST_F(ReadTime, RefusesTheRestByName) {
  for (const char* text : {"", "noon", "25:00", "yesterday", "-3 min ago", "nan min ago", "3 ago",
                           "20 min ago, about", "12:00 pm", "1e15"}) {
    const auto time = read_time("--at", text, kNow);
    ASSERT_FALSE(time.ok()) << text;
    EXPECT_EQ(time.error().field, "--at") << text;
  }
}

}  // namespace
}  // namespace anchord
