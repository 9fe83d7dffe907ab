#include <gtest/gtest.h>

#include <cmath>

#include "geometry/polygon.h"
#include "knowledge/configuration.h"
#include "maintenance/planner.h"
#include "tests/maintenance/small_home.h"

namespace anchord {
namespace {

class Home : public testing::Test {
 protected:
  const Knowledge home =
      read_configuration(std::string(ANCHORD_SOURCE_DIR) + "/config/home.json").knowledge();
  const Site site{home};
};

TEST_F(Home, EveryPlaceForThingsCanBeReachedAndSeen) {
  ASSERT_EQ(site.eyes.size(), 1u);
  const BasePose hall{{6, 4.5}, 0, 0};
  const WayMap::Start start = site.ways.start(hall.position);
  int places = 0;
  for (const Place& place : home.places) {
    if (place.parent < 0) continue;
    ++places;
    Eigen::Vector3d middle = moments_of(place.region.polygon).mean;
    middle.z() = (place.region.z_min + place.region.z_max) / 2;
    const auto base = viewpoint_of(middle, site.eyes[0], hall, site);
    ASSERT_TRUE(base) << place.name;
    EXPECT_TRUE(site.sees(site.eyes[0], *base, middle)) << place.name;
    EXPECT_LT(site.ways.length(start, base->position), 15) << place.name;  // across the apartment
  }
  EXPECT_GE(places, 10);
}

TEST_F(Home, ARoomIsEnteredByItsDoor) {
  const WayMap::Start hall = site.ways.start({6, 4.5});
  const Way way = site.ways.way(hall, {1, 1});  // the kitchen, whose door is at x = 2 to 2.9
  ASSERT_TRUE(std::isfinite(way.length));
  bool through = false;
  for (std::size_t i = 1; i < way.points.size(); ++i) {
    const Eigen::Vector2d a = way.points[i - 1], b = way.points[i];
    EXPECT_FALSE(site.ways.walls().between(a, b));
    if ((a.y() - 3.9) * (b.y() - 3.9) > 0) continue;
    const double x = a.x() + (3.9 - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    through = through || (x > 2 && x < 2.9);
  }
  EXPECT_TRUE(through);
}

TEST_F(Home, AThingUnseenForAnHourIsLookedAt) {
  Gaussian position;
  position.mean = {3, 2.4, 0.8};  // on the kitchen table
  position.covariance = 0.001 * Eigen::Matrix3d::Identity();
  position.covariance(0, 0) += 0.36, position.covariance(1, 1) += 0.36;
  const std::vector<Subject> subjects{
      single_subject("cup-1", position, 1e-4, 0.9, home.find_class("cup"), home)};
  const auto action = choose(subjects, robot_at(6, 4.5), site);
  ASSERT_TRUE(action);
  EXPECT_EQ(action->sensor, "kinect");
  EXPECT_GT(action->gain, home.maintenance.threshold);
}

}  // namespace
}  // namespace anchord
