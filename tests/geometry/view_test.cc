#include "geometry/view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "tests/geometry/sampling.h"

namespace anchord {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

View good(View::Type type) {
  View view;
  view.type = type;
  view.range = {0.5, 4};
  view.bearing = {-0.8, 0.9};
  view.elevation = {-0.6, 0.5};
  view.hfov = 1;
  view.vfov = 0.8;
  view.points = {{0, 0}, {3, -1}, {3, 2}, {1, 1}};
  return view;
}

const View::Type kBounded[] = {View::Type::kSector, View::Type::kFrustum, View::Type::kPolygon};

TEST(MapView, ContainsWhatTheDefinitionSays) {
  Sampler sampler(1);
  int seen = 0;
  for (int i = 0; i < 20'000; ++i) {
    View view = good(i % 2 ? View::Type::kSector : View::Type::kFrustum);
    const int dims = i % 4 < 2 ? 2 : 3;
    view.bearing = {sampler.uniform(-7, 7), sampler.uniform(-7, 7)};
    const Eigen::Vector3d p(sampler.uniform(-4, 4), sampler.uniform(-4, 4),
                            dims == 2 ? 0 : sampler.uniform(-3, 3));
    const Eigen::Vector3d t(1, -2, dims == 2 ? 0 : 0.5);
    const auto q = dims == 2 ? turned(sampler.uniform(-4, 4), {0, 0, 1}) : sampler.orientation();
    const MapView at = *MapView::place(view, exact_pose(t, q), dims);
    const Eigen::Vector3d in_map = t + Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * p;
    ASSERT_EQ(at.contains(in_map), in_view(view, p, dims)) << i;
    seen += at.contains(in_map);
  }
  EXPECT_GT(seen, 2000);
}

TEST(MapView, BearingsWrapAround) {
  View view = good(View::Type::kSector);
  const auto sees = [&](double from, double to, double bearing) {
    view.bearing = {from, to};
    return MapView::place(view, {}, 2)->contains({2 * std::cos(bearing), 2 * std::sin(bearing), 0});
  };
  EXPECT_TRUE(sees(3, -3, kPi));
  EXPECT_FALSE(sees(3, -3, 0));
  EXPECT_FALSE(sees(-3, 3, kPi));
  EXPECT_TRUE(sees(-3, 3, 0));
  EXPECT_TRUE(sees(-kPi, kPi, kPi));
  EXPECT_TRUE(sees(0, 2 * kPi, 5));
  EXPECT_TRUE(sees(0, 100, -1));
  EXPECT_TRUE(sees(100, 101, 100.5));
}

TEST(MapView, WorldSeesEverythingAndNoneNothing) {
  View view;
  const Gaussian density{{1, 2, 0}, Eigen::Matrix3d::Identity()};
  view.type = View::Type::kWorld;
  const MapView world = *MapView::place(view, {}, 3);
  EXPECT_TRUE(world.sees_everything());
  EXPECT_TRUE(world.contains({1e6, 0, 0}));
  EXPECT_EQ(world.mass(density), 1);
  EXPECT_EQ(world.share({0, 0, 0}, {1, 1, 1}), 1);
  EXPECT_EQ(world.bounds(), (std::array<double, 4>{-kInfinity, -kInfinity, kInfinity, kInfinity}));
  view.type = View::Type::kNone;
  const MapView none = *MapView::place(view, {}, 3);
  EXPECT_TRUE(none.sees_nothing());
  EXPECT_FALSE(none.contains({0, 0, 0}));
  EXPECT_EQ(none.mass(density), 0);
  EXPECT_EQ(none.share({0, 0, 0}, {1, 1, 1}), 0);
  EXPECT_EQ(none.bounds(), (std::array<double, 4>{0, 0, 0, 0}));
}

TEST(MapView, ShareAgreesWithAFineGridAndTheBoundsHoldAllThatIsSeen) {
  Sampler sampler(2);
  for (int i = 0; i < 300; ++i) {
    const int dims = i % 2 ? 2 : 3;
    View view = good(kBounded[i % 3]);
    view.bearing[0] = sampler.uniform(-3, 3);
    view.bearing[1] = view.bearing[0] + sampler.uniform(0.3, 6.2);
    const MapView at =
        *MapView::place(view, exact_pose({0.1, 0.2, 1}, sampler.orientation()), dims);
    const auto bounds = at.bounds();
    ASSERT_LT(bounds[2] - bounds[0], 2 * 4 * 1.4) << "the bounds are loose";
    for (int j = 0; j < 20; ++j) {
      const Eigen::Vector3d low(sampler.uniform(-4, 4), sampler.uniform(-4, 4), 0);
      const Eigen::Vector3d high = low + Eigen::Vector3d(0.25, 0.25, dims == 2 ? 0 : 2.5);
      const int across = 16, up = dims == 2 ? 1 : 32;
      int seen = 0;
      for (int n = 0; n < across * across * up; ++n) {
        const Eigen::Vector3d at_share((n % across + 0.5) / across,
                                       (n / across % across + 0.5) / across,
                                       (n / across / across + 0.5) / up);
        const Eigen::Vector3d point = low + (high - low).cwiseProduct(at_share);
        if (!at.contains(point)) continue;
        ++seen;
        ASSERT_TRUE(point.x() >= bounds[0] && point.y() >= bounds[1] && point.x() <= bounds[2] &&
                    point.y() <= bounds[3]);
      }
      const double expected = static_cast<double>(seen) / (across * across * up);
      const double share = at.share(low, high);
      // 0.05 as view.h promises, 1/32 for half a cell of the fine grid along an edge.
      ASSERT_NEAR(share, expected, 0.05 + 1.0 / 32) << i << " " << j;
      if (share == 0 || share == 1) {
        ASSERT_NEAR(share, expected, 1.0 / 32) << i << " " << j;
      }
    }
  }
}

TEST(MapView, ShareOfAPolygonIsExact) {
  View view = good(View::Type::kPolygon);
  view.points = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  const MapView at = *MapView::place(view, {}, 2);
  EXPECT_DOUBLE_EQ(at.share({0.5, 0.5, 0}, {1.5, 1.5, 0}), 0.75);
  EXPECT_DOUBLE_EQ(at.share({-1, -1, 0}, {3, 3, 0}), 3.0 / 16);
  EXPECT_EQ(at.share({0.1, 0.1, 0}, {0.9, 0.9, 0}), 1);
  EXPECT_EQ(at.share({1.2, 1.2, 0}, {1.9, 1.9, 0}), 0);
}

TEST(MapView, OfAPolygonKeepsTheHeadingOfATiltedSensor) {
  const View view = good(View::Type::kPolygon);
  // Heading 90 degrees, then pitched down by 0.4: the prism stays upright.
  const Eigen::Quaterniond q(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()));
  const MapView at = *MapView::place(view, exact_pose({1, 1, 1}, {q.w(), q.x(), q.y(), q.z()}), 3);
  EXPECT_TRUE(at.contains({1 - 0.5, 1 + 2, 50}));  // sensor frame (2, 0.5)
  EXPECT_FALSE(at.contains({1 + 0.9, 1 + 2, 50}));
}

TEST(MapView, ComparesByValue) {
  const View view = good(View::Type::kPolygon);
  EXPECT_EQ(*MapView::place(view, {}, 2), *MapView::place(view, {}, 2));
  EXPECT_NE(*MapView::place(view, {}, 2), *MapView::place(good(View::Type::kSector), {}, 2));
}

void refused(const View& view, const char* field, const std::optional<Pose>& pose = {}) {
  const auto result = MapView::place(view, pose, 3);
  ASSERT_FALSE(result.ok()) << field;
  EXPECT_EQ(result.error().field, field);
}

TEST(MapView, RefusesAndNamesTheField) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (const int i : {0, 1}) {
      View view = good(View::Type::kSector);
      view.range[i] = bad;
      refused(view, "view.range");
      view = good(View::Type::kSector);
      view.bearing[i] = bad;
      refused(view, "view.bearing");
      view = good(View::Type::kSector);
      view.elevation[i] = bad;
      refused(view, "view.elevation");
    }
  }
  View view = good(View::Type::kSector);
  view.bearing = {1, 1};
  refused(view, "view.bearing");
  view = good(View::Type::kSector);
  view.elevation = {0.3, 0.2};
  refused(view, "view.elevation");
  view.elevation = {2, 3};
  refused(view, "view.elevation");
  for (const View::Type type : {View::Type::kSector, View::Type::kFrustum}) {
    view = good(type);
    view.range = {4, 0.5};
    refused(view, "view.range");
    view.range = {2, 2};
    refused(view, "view.range");
    view.range = {-1, 2};
    refused(view, "view.range");
  }
  for (const double bad : {kNan, 0.0, -1.0, kPi, kInfinity}) {
    view = good(View::Type::kFrustum);
    view.hfov = bad;
    refused(view, "view.hfov");
    view = good(View::Type::kFrustum);
    view.vfov = bad;
    refused(view, "view.vfov");
  }
  view = good(View::Type::kPolygon);
  view.points[2][1] = kNan;
  refused(view, "view.points[2]");
  view.points = {{0, 0}, {1, 1}};
  refused(view, "view.points");
  view.points = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  refused(view, "view.points");
  view.type = static_cast<View::Type>(77);
  refused(view, "view.type");
  refused(good(View::Type::kSector), "pose.orientation", exact_pose({0, 0, 0}, {0, 0, 0, 0}));
}

}  // namespace
}  // namespace anchord
