#include "api/parameters.h"

#include <gtest/gtest.h>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

const Background& background() {
  static const Background instance(small_world());
  return instance;
}

Result<Parameters> read(std::vector<std::pair<std::string, std::string>> parameters,
                        const std::string& allowed = "description place object min_p limit") {
  return read_parameters({"/v1/objects", std::move(parameters)}, allowed, background());
}

TEST(Parameters, AreResolved) {
  const auto p = read({{"class", "box"},
                       {"size", "large"},
                       {"place", "table"},
                       {"min_p", "0.25"},
                       {"limit", "7"},
                       {"object", "cup-1"}});
  ASSERT_TRUE(p.ok());
  ASSERT_EQ(p->description.terms.size(), 2u);
  EXPECT_EQ(p->description.terms[0].attribute, background().knowledge.class_attribute);
  EXPECT_EQ(p->description.terms[0].symbol, 1);
  EXPECT_EQ(p->description.terms[1].symbol, 1);
  EXPECT_EQ(p->place, background().knowledge.find_place("table"));
  EXPECT_EQ(p->min_p, 0.25);
  EXPECT_EQ(p->limit, 7);
  EXPECT_EQ(p->object, "cup-1");
  EXPECT_TRUE(p->filters());
}

TEST(Parameters, NoneAreNone) {
  const auto p = read({});
  ASSERT_TRUE(p.ok());
  EXPECT_FALSE(p->filters());
  EXPECT_FALSE(p->min_p);
  EXPECT_EQ(p->place, -1);
}

TEST(Parameters, RefusalsSayWhatThereIs) {
  const auto color = read({{"color", "pink"}});
  ASSERT_FALSE(color.ok());
  EXPECT_EQ(color.error().code, ErrorCode::kInvalid);
  EXPECT_NE(color.error().message.find("red, green, blue"), std::string::npos);
  const auto size = read({{"size", ""}});
  ASSERT_FALSE(size.ok());
  EXPECT_NE(size.error().message.find("small, large"), std::string::npos);
  const auto unknown = read({{"clas", "cup"}});
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().field, "clas");
  EXPECT_NE(unknown.error().message.find("class"), std::string::npos);
}

TEST(Parameters, OnlyWhatTheQuestionTakes) {
  EXPECT_EQ(read({{"limit", "3"}}, "description place").error().field, "limit");
  EXPECT_EQ(read({{"class", "cup"}}, "limit").error().field, "class");
  EXPECT_EQ(read({{"description", "x"}}).error().field, "description");
  EXPECT_TRUE(read({{"limit", "3"}}, "limit").ok());
}

TEST(Parameters, NumbersAreNumbers) {
  for (const char* p : {"", "x", "0.5x", "-0.1", "1.1", "nan", "inf", " 0.5", "1e400"})
    EXPECT_EQ(read({{"min_p", p}}).error().field, "min_p") << p;
  for (const char* n : {"", "0", "-1", "1001", "2.5", "1e2", "99999999999999999999"})
    EXPECT_EQ(read({{"limit", n}}).error().field, "limit") << n;
  EXPECT_TRUE(read({{"min_p", "0"}, {"limit", "1000"}}).ok());
  EXPECT_TRUE(read({{"min_p", "1e-3"}}).ok());
}

}  // namespace
}  // namespace anchord
