#include "tools/anchorctl/places.h"

#include <gtest/gtest.h>

#include "tools/anchorctl/table.h"

namespace anchord {
namespace {

Json entry(Json place, double p) { return {{"place", std::move(place)}, {"p", p}}; }
Json entry(Json place, double p, Json parent) {
  return {{"place", std::move(place)}, {"p", p}, {"parent", std::move(parent)}};
}

std::string plain(const Json& entries) {
  // Parts are glued for tables; a table of one cell makes them readable.
  Table table({{""}});
  table.add({places(entries)});
  std::string text = table.text({});
  text.pop_back();
  return text;
}

TEST(Places, DeepestOnesAndWhatIsLeft) {
  EXPECT_EQ(plain({entry("kitchen", 0.9, nullptr), entry("kitchen_table", 0.68, "kitchen"),
                   entry("sink", 0.2, "kitchen"), entry(nullptr, 0.1, nullptr)}),
            "kitchen_table 0.68, sink 0.20, elsewhere 0.12");
}

TEST(Places, RestOfARoom) {
  EXPECT_EQ(plain({entry("kitchen_table", 0.68, "kitchen"), entry("kitchen", 0.8, nullptr),
                   entry(nullptr, 0.2, nullptr)}),
            "kitchen_table 0.68, rest of kitchen 0.12, elsewhere 0.20");
}

TEST(Places, ThinMassCountsForThePlaceAroundIt) {
  EXPECT_EQ(plain({entry("home", 1, nullptr), entry("kitchen", 0.98, "home"),
                   entry("sink", 0.03, "counter"), entry("counter", 0.04, "kitchen")}),
            "kitchen 0.98, elsewhere 0.02");
}

TEST(Places, WithoutParentsDisjointOnesAreParts) {
  EXPECT_EQ(plain({entry("lawn", 0.7), entry("path", 0.2), entry(nullptr, 0.1)}),
            "lawn 0.70, path 0.20, elsewhere 0.10");
}

TEST(Places, WithoutParentsNestedOnesStayAsTheyCame) {
  EXPECT_EQ(plain({entry("kitchen", 0.8), entry("kitchen_table", 0.68), entry("sink", 0.01),
                   entry(nullptr, 0.2)}),
            "kitchen 0.80, kitchen_table 0.68, elsewhere 0.20");
}

TEST(Places, NonsenseDoesNotHang) {
  EXPECT_EQ(plain({entry("a", 0.4, "b"), entry("b", 0.4, "a"), entry("c", 0.2, "c")}),
            "b 0.40, c 0.20, elsewhere 0.40");
  EXPECT_EQ(plain(Json::array()), "elsewhere 1.00");
  EXPECT_EQ(plain({1, "x"}), "elsewhere 1.00");
}

}  // namespace
}  // namespace anchord
