#include "tools/anchorctl/format.h"

#include <gtest/gtest.h>

#include "tests/anchorctl/utc.h"
#include "tools/anchorctl/table.h"

namespace anchord {
namespace {

TEST(Format, ProbabilitiesNeverRoundToCertainty) {
  EXPECT_EQ(probability(0.684), "0.68");
  EXPECT_EQ(probability(0.996), "0.996");
  EXPECT_EQ(probability(0.9999), ">0.999");
  EXPECT_EQ(probability(0.004), "0.004");
  EXPECT_EQ(probability(1e-9), "<0.001");
  EXPECT_EQ(probability(0), "0.00");
  EXPECT_EQ(probability(1), "1.00");
  EXPECT_EQ(probability(std::nullopt), "-");
}

TEST(Format, SpansInTheirUnit) {
  EXPECT_EQ(duration(0), "0 s");
  EXPECT_EQ(duration(0.00031), "0.31 ms");
  EXPECT_EQ(duration(0.0042), "4.2 ms");
  EXPECT_EQ(duration(0.25), "0.25 s");
  EXPECT_EQ(duration(3.2), "3.2 s");
  EXPECT_EQ(duration(42), "42 s");
  EXPECT_EQ(duration(720), "12 min");
  EXPECT_EQ(duration(3.1 * 3600), "3.1 h");
  EXPECT_EQ(duration(5 * 86400), "5.0 days");
}

TEST(Format, Bytes) {
  EXPECT_EQ(bytes(0), "0 B");
  EXPECT_EQ(bytes(1'200'000), "1.2 MB");
  EXPECT_EQ(bytes(999'900), "1.0 MB");
  EXPECT_EQ(bytes(345'000), "345 kB");
}

TEST(Format, TimesAreLocalWithTheirAge) {
  use_utc();
  EXPECT_EQ(date_and_time(kT), "2023-11-14 22:13:20 UTC");
  EXPECT_EQ(seen(kT, kT), "22:13:20 (now)");
  EXPECT_EQ(seen(kT, kT + 3'200'000), "22:13:20 " + glued("(3.2 s ago)"));
  EXPECT_EQ(seen(kT, kT + 86'400'000'000), "2023-11-14 22:13:20 " + glued("(24 h ago)"));
  EXPECT_EQ(seen(kT + 1'000'000, kT), "22:13:21 " + glued("(in 1.0 s)"));
  EXPECT_EQ(seen(std::nullopt, kT), "-");
  setenv("TZ", "EST5", 1);  // five hours behind UTC, without summer time
  tzset();
  EXPECT_EQ(seen(kT, kT), "17:13:20 (now)");
  use_utc();
}

TEST(Format, PositionsWithTheLargestSigma) {
  EXPECT_EQ(position({1.02, 0.2, -0.9}), "1.02, 0.20, -0.90");
  EXPECT_EQ(position({1, 2}, {0.01, 9, 9, 0.04}), "1.00, 2.00 ±0.20");
  EXPECT_EQ(position({1, 2}, {0.01, 9, 9}), "1.00, 2.00") << "no square";
  EXPECT_EQ(position({}), "-");
  EXPECT_EQ(decimal(1e12), "1.00e+12");
}

TEST(Format, Attributes) {
  EXPECT_EQ(attribute(Json{{"blue", 0.08}, {"green", 0.9}, {"red", 0.001}}),
            glued("green 0.90") + ", " + glued("blue 0.08"));
  EXPECT_EQ(attribute(Json{{"mean", 0.12}, {"variance", 0.0004}}), "0.120 ±0.020");
  EXPECT_EQ(attribute(Json{{"mean", 0.12}, {"unit", "m"}}), "0.120 m");
  EXPECT_EQ(attribute(Json(7)), "-");
  EXPECT_EQ(class_of(Json{{"class", "cup"}}), "cup");
}

TEST(Fields, WhatIsMissingOrWrongReadsAsNothing) {
  const Json object{{"p", "high"}, {"id", 3}, {"utime", 5}, {"position", {1, "x"}}, {"z", nullptr}};
  EXPECT_EQ(number(object, "p"), std::nullopt);
  EXPECT_EQ(text(object, "id"), "-");
  EXPECT_EQ(utime(object, "utime"), std::nullopt) << "1970";
  EXPECT_TRUE(numbers(object, "position").empty());
  EXPECT_EQ(member(object, "z"), nullptr);
  EXPECT_EQ(member(Json(3), "z"), nullptr);
  EXPECT_TRUE(items(object, "p").empty());
}

TEST(Fields, NothingFromTheNetworkSteersTheTerminal) {
  EXPECT_EQ(printable("a\x1b[2Jb\n\x01\x7f"), "a?[2Jb???");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "?2J");
  EXPECT_EQ(printable("küche"), "küche");
}

}  // namespace
}  // namespace anchord
