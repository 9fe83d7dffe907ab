#include "geometry/region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace anchord {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

const Polygon kL = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

TEST(Region, ContainsWhatIsInsideInEitherOrientation) {
  const Region region{kL, 0, 1};
  const Region reversed{Polygon(kL.rbegin(), kL.rend()), 0, 1};
  for (const Region& r : {region, reversed}) {
    EXPECT_TRUE(r.contains({0.5, 1.5, 0.5}, 3));
    EXPECT_FALSE(r.contains({1.5, 1.5, 0.5}, 3));
    EXPECT_FALSE(r.contains({0.5, 0.5, 1.5}, 3));
    EXPECT_TRUE(r.contains({0.5, 0.5, 1.5}, 2));
    EXPECT_DOUBLE_EQ(r.area(), 3);
    EXPECT_DOUBLE_EQ(r.volume(3), 3);
    EXPECT_DOUBLE_EQ(r.volume(2), 3);
  }
  EXPECT_EQ((Region{kL}).volume(3), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(region.contains({NAN, 0.5, 0.5}, 3));
}

TEST(Region, BoxHasItsCornersAndHeights) {
  const Region region = box({1, 2, 3}, {2, 4, 7});
  EXPECT_DOUBLE_EQ(region.volume(3), 8);
  EXPECT_TRUE(region.contains({1.5, 3, 5}, 3));
  EXPECT_FALSE(region.contains({1.5, 3, 7.1}, 3));
}

TEST(CheckPolygon, AcceptsSimplePolygons) {
  EXPECT_TRUE(check_polygon(kL, "p").ok());
  EXPECT_TRUE(check_polygon(Polygon(kL.rbegin(), kL.rend()), "p").ok());
  // Closed by repeating the first point, as some formats do; a point in the middle of an edge.
  EXPECT_TRUE(check_polygon({{0, 0}, {1, 0}, {1, 1}, {0, 0}}, "p").ok());
  EXPECT_TRUE(check_polygon({{0, 0}, {1, 0}, {2, 0}, {1, 1}}, "p").ok());
}

TEST(CheckPolygon, RefusesAndNamesTheField) {
  const auto refused = [](const Polygon& polygon, const char* field = "places[2].polygon") {
    const Status status = check_polygon(polygon, "places[2].polygon");
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().field, field);
  };
  refused({});
  refused({{0, 0}, {1, 0}});
  refused({{0, 0}, {1, 0}, {1, 0}});
  refused({{0, 0}, {1, 1}, {2, 2}});
  refused({{0, 0}, {1, NAN}, {1, 1}}, "places[2].polygon[1]");
  refused({{0, 0}, {1, 0}, {INFINITY, 1}}, "places[2].polygon[2]");
  refused({{-1e200, -1e200}, {1e200, 0}, {0, 1e200}});        // the area overflows
  refused({{0, 0}, {2, 2}, {2, 0}, {0, 1}});                  // a bow tie
  refused({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}});          // a corner touches an edge
  refused({{0, 0}, {2, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}});  // a spike
  Polygon many;
  for (std::size_t i = 0; i <= kMaxPolygonPoints; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / (kMaxPolygonPoints + 1);
    many.emplace_back(std::cos(angle), std::sin(angle));
  }
  refused(many);
  many.pop_back();
  EXPECT_TRUE(check_polygon(many, "p").ok());
}

}  // namespace
}  // namespace anchord
