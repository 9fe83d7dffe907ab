#include "api/http_message.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace anchord {
namespace {

TEST(ParseTarget, SplitsAndDecodes) {
  auto target =
      parse_target("/v1/objects/tea%20box-1?class=tea_box&color=light+blue&x=%2B%26&x=&y");
  ASSERT_TRUE(target.ok()) << target.error().text();
  EXPECT_EQ(target->path, "/v1/objects/tea box-1");
  const decltype(target->parameters) expected = {
      {"class", "tea_box"}, {"color", "light blue"}, {"x", "+&"}, {"x", ""}, {"y", ""}};
  EXPECT_EQ(target->parameters, expected);
}

TEST(ParseTarget, LeavesAPlusInThePathAndSkipsEmptyParameters) {
  auto target = parse_target("/a+b?&&=1&");
  ASSERT_TRUE(target.ok());
  EXPECT_EQ(target->path, "/a+b");
  ASSERT_EQ(target->parameters.size(), 1u);
  EXPECT_EQ(target->parameters[0], std::make_pair(std::string(), std::string("1")));
}

TEST(ParseTarget, TakesTheAbsoluteFormAndTheAsterisk) {
  EXPECT_EQ(parse_target("http://localhost:7780/v1/status?a=1")->path, "/v1/status");
  EXPECT_EQ(parse_target("http://localhost:7780")->path, "/");
  EXPECT_EQ(parse_target("*")->path, "*");
}

TEST(ParseTarget, RefusesWhatIsBroken) {
  for (const char* broken :
       {"", "v1/objects", "?a=1", "/%", "/%4", "/%zz", "/a?b=%", "/a?b=%1", "/a?%g0=1", "/%00",
        "/a?b=%0a", "/%ff", "/a?b=%c3%28", "http://host?a=1"}) {
    auto target = parse_target(broken);
    ASSERT_FALSE(target.ok()) << broken;
    EXPECT_EQ(target.error().field, "target");
  }
}

TEST(HttpError, HasTheShapeOfAllErrors) {
  const auto response = http_error(invalid("detections[3].covariance", "must be \"symmetric\""));
  EXPECT_EQ(response.status, 400);
  EXPECT_EQ(response.content_type, "application/json");
  const nlohmann::json expected = {{"error",
                                    {{"code", "invalid"},
                                     {"message", "must be \"symmetric\""},
                                     {"field", "detections[3].covariance"}}}};
  EXPECT_EQ(nlohmann::json::parse(response.body), expected);
  const auto bare = nlohmann::json::parse(http_error(500, "internal", "bad \xff byte").body);
  EXPECT_FALSE(bare["error"].contains("field"));
  EXPECT_EQ(http_error(Error{ErrorCode::kUnknown, "", ""}).status, 404);
  EXPECT_EQ(http_error(Error{ErrorCode::kConflict, "", ""}).status, 409);
  EXPECT_EQ(http_error(Error{ErrorCode::kTooLarge, "", ""}).status, 413);
  EXPECT_EQ(http_error(Error{ErrorCode::kUnavailable, "", ""}).status, 503);
  EXPECT_EQ(http_error(Error{ErrorCode::kIo, "", ""}).status, 500);
  EXPECT_EQ(http_error(Error{ErrorCode::kStorage, "", ""}).status, 507);
}

}  // namespace
}  // namespace anchord
