#include "tools/anchor_tune/finding.h"

#include <gtest/gtest.h>

namespace anchord::tuning {
namespace {

using nlohmann::json;

json parsed(const std::string& text) { return json::parse(text, nullptr, true, true); }

TEST(Finding, StandsInItsPlaceWithItsReasonAbove) {
  const std::string text =
      tuned_text({{"world", {{"cell", 1}}}, {"classes", {{"cup", {{"departure_rate", 1}}}}}},
                 {{JsonPath("/classes/cup/departure_rate"), 0.25, "Counted."},
                  {JsonPath(), nullptr, "A remark."}},
                 "Title.");
  EXPECT_EQ(text,
            "// Title.\n"
            "// - A remark.\n"
            "{\n"
            "  \"world\": {\"cell\": 1},\n"
            "  \"classes\": {\n"
            "    \"cup\": {\n"
            "      // Counted.\n"
            "      \"departure_rate\": 0.25\n"
            "    }\n"
            "  }\n"
            "}\n");
}

TEST(Finding, NullTakesAKeyAway) {
  const auto text =
      tuned_text({{"a", 1}, {"b", {{"c", 2}}}},
                 {{JsonPath("/a"), nullptr, ""}, {JsonPath("/x/y"), nullptr, ""}}, "");
  EXPECT_EQ(parsed(text), json({{"b", {{"c", 2}}}}));
}

TEST(Finding, ANumberThatGetsMembersStandsForTheOthers) {
  const auto text = tuned_text({{"p", 0.9}}, {{JsonPath("/p/cup"), 0.5, "Why."}}, "");
  EXPECT_EQ(parsed(text), json({{"p", {{"default", 0.9}, {"cup", 0.5}}}}));
}

TEST(Finding, AnArrayThatGetsMembersByNameDoesSo) {
  const auto text =
      tuned_text({{"p", {0.9, -0.1}}},
                 {{JsonPath("/p/cup"), {0.5, -0.2}, ""}, {JsonPath("/p/cup/1"), -0.3, "Why."}}, "");
  EXPECT_EQ(parsed(text), json({{"p", {{"default", {0.9, -0.1}}, {"cup", {0.5, -0.3}}}}}));
}

TEST(Finding, LongReasonsAreWrapped) {
  const auto text = tuned_text({{"a", 1}}, {{JsonPath("/a"), 2, std::string(300, 'x') + " y"}}, "");
  EXPECT_NE(text.find("x\n  // y\n"), std::string::npos);
  EXPECT_EQ(parsed(text), json({{"a", 2}}));
}

TEST(Finding, HasFourDigits) {
  EXPECT_EQ(number(0.123456), 0.1235);
  EXPECT_EQ(number(1234567), 1235000);
  EXPECT_EQ(number(0.99998765432), 1 - 1.235e-05);
  const Finding f = estimated(JsonPath("/a"), {0.5, 0.25, 0.75}, "Of 4");
  EXPECT_EQ(f.why, "Of 4: 0.5 (95 %: 0.25 to 0.75).");
  EXPECT_EQ(report_text({f}), "a 0.5: Of 4: 0.5 (95 %: 0.25 to 0.75).\n");
}

}  // namespace
}  // namespace anchord::tuning
