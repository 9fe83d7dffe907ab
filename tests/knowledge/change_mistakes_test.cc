#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "knowledge/configuration.h"

namespace anchord {
namespace {

const std::string kStart = R"({"world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}}, )";

TEST(ChangeMistakes, SymbolsChangeIntoOtherSymbols) {
  for (const auto& [change, path, message] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {R"({"drift": 1})", ".drift", "no such key"},
           {R"({"redraw": -1})", ".redraw", "[0, 1e+06]"},
           {R"({"redraw": 1, "transitions": []})", "", "either"},
           {R"({"transitions": {}})", ".transitions", "must be an array"},
           {R"({"transitions": [{"from": "a", "to": "b"}]})", ".transitions[0].rate", "is missing"},
           {R"({"transitions": [{"to": "b", "rate": 1}]})", ".transitions[0].from", "is missing"},
           {R"({"transitions": [{"from": "a", "to": "z", "rate": 1}]})", ".transitions[0].to",
            "no symbol is called \"z\""},
           {R"({"transitions": [{"from": "a", "to": "a", "rate": 1}]})", ".transitions[0]",
            "another symbol"},
           {R"({"transitions": [{"from": "a", "to": "b", "rate": 1},
                                {"from": "a", "to": "b", "rate": 2}]})",
            ".transitions[1]", "there already"}}) {
    const auto configuration = parse_configuration(kStart + R"("attributes": {
            "color": {"kind": "categorical", "symbols": ["a", "b"]}},
            "classes": {"object": {"changes": {"color": )" +
                                                   change + "}}}}");
    ASSERT_EQ(configuration.mistakes().size(), 1u) << change;
    EXPECT_EQ(configuration.mistakes()[0].path, "classes.object.changes.color" + path);
    EXPECT_NE(configuration.mistakes()[0].message.find(message), std::string::npos)
        << configuration.mistakes()[0].message;
  }
}

TEST(ChangeMistakes, AtMostTwentySymbolsAreJoined) {
  std::string symbols = "\"s0\"", transitions;
  for (int s = 1; s <= static_cast<int>(kMostChanging); ++s) {
    symbols += ", \"s" + std::to_string(s) + "\"";
    transitions += std::string(s > 1 ? ", " : "") + R"({"from": "s)" + std::to_string(s - 1) +
                   R"(", "to": "s)" + std::to_string(s) + R"(", "rate": 1})";
  }
  const auto configuration = parse_configuration(
      kStart + R"("attributes": {
          "color": {"kind": "categorical", "symbols": [)" +
      symbols + R"(]}}, "classes": {"object": {"changes": {"color": {"transitions": [)" +
      transitions + "]}}}}}");
  ASSERT_EQ(configuration.mistakes().size(), 1u);
  EXPECT_EQ(configuration.mistakes()[0].path, "classes.object.changes.color.transitions");
}

}  // namespace
}  // namespace anchord
