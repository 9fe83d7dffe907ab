#include "tools/anchorctl/query.h"

#include <gtest/gtest.h>

#include "core/percent_encoding.h"
#include "tools/anchorctl/http_client.h"

namespace anchord {
namespace {

std::string target(const std::string& command, const std::vector<std::string>& words) {
  auto parameters = parse_words(words);
  return parameters ? make_target(command, *parameters) : "refused: " + parameters.error().text();
}

TEST(Query, BareWordIsAClassOrAnObject) {
  EXPECT_EQ(target("where", {"cup"}), "/v1/where?class=cup");
  EXPECT_EQ(target("where", {"cup-12"}), "/v1/where?object=cup-12");
  EXPECT_EQ(target("where", {"tea_box-3"}), "/v1/where?object=tea_box-3");
  EXPECT_EQ(target("where", {"t-shirt"}), "/v1/where?class=t-shirt");
  EXPECT_EQ(target("where", {"cup-"}), "/v1/where?class=cup-");
  EXPECT_EQ(target("hypotheses", {}), "/v1/hypotheses");
}

TEST(Query, PairsAndOptionsBecomeParametersInTheirOrder) {
  EXPECT_EQ(target("where", {"cup", "color=blue", "size=small"}),
            "/v1/where?class=cup&color=blue&size=small");
  EXPECT_EQ(target("count", {"--class", "cup", "--color=blue", "--place", "kitchen"}),
            "/v1/count?class=cup&color=blue&place=kitchen");
  EXPECT_EQ(target("objects", {"--min-p", "0.5", "cup"}), "/v1/objects?min_p=0.5&class=cup");
  EXPECT_EQ(target("where", {"--offset", "-5"}), "/v1/where?offset=-5");
}

TEST(Query, OneObjectIsPartOfThePath) {
  EXPECT_EQ(target("objects", {"cup-1"}), "/v1/objects/cup-1");
  EXPECT_EQ(target("objects", {"--object", "cup-1", "k=v"}), "/v1/objects/cup-1?k=v");
  EXPECT_EQ(target("objects", {"object=a/b"}), "/v1/objects/a%2Fb");
}

TEST(Query, ValuesArePercentEncoded) {
  EXPECT_EQ(target("where", {"color=light blue&x=1"}), "/v1/where?color=light%20blue%26x%3D1");
  EXPECT_EQ(target("where", {"place=küche"}), "/v1/where?place=k%C3%BCche");
  EXPECT_EQ(percent_encoded("aZ09-._~+%\n"), "aZ09-._~%2B%25%0A");
}

TEST(Query, RefusesWhatMakesNoSense) {
  EXPECT_EQ(target("where", {"cup", "blue"}).substr(0, 14), "refused: blue:");
  EXPECT_EQ(target("where", {"cup", "--class", "mug"}), "refused: class: is given twice");
  EXPECT_EQ(target("where", {"--color"}), "refused: --color: needs a value");
  EXPECT_EQ(target("where", {"--color", "--place", "x"}), "refused: --color: needs a value");
  EXPECT_EQ(target("where", {"-x"}), "refused: -x: no such option");
  EXPECT_EQ(target("where", {"=blue"}).substr(0, 15), "refused: =blue:");
}

TEST(Server, ReadsAddresses) {
  for (const auto& [given, read] :
       std::vector<std::pair<std::string, std::string>>{{"127.0.0.1:7780", "127.0.0.1:7780"},
                                                        {"http://robot:80/", "robot:80"},
                                                        {"robot", "robot:7780"},
                                                        {"[::1]:99", "[::1]:99"},
                                                        {"[::1]", "[::1]:7780"}}) {
    const auto server = parse_server(given);
    ASSERT_TRUE(server.ok()) << given;
    EXPECT_EQ(server->text(), read);
  }
  EXPECT_EQ(parse_server("[::1]:99")->host, "::1");
}

TEST(Server, RefusesOthers) {
  for (const char* given : {"", ":80", "robot:", "robot:x", "robot:0", "robot:65536", "::1",
                            "robot/path", "https://robot:80", "[]:80", "robot:123456789012"}) {
    const auto server = parse_server(given);
    ASSERT_FALSE(server.ok()) << given;
    EXPECT_EQ(server.error().field, "--server");
  }
}

}  // namespace
}  // namespace anchord
