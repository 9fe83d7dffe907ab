#include "perception/task_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace anchord {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Task good() {
  RegionOfInterest ellipsoid;
  ellipsoid.p = 0.5;
  ellipsoid.covariance = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  ellipsoid.radius = 2;
  RegionOfInterest prism;
  prism.kind = RegionOfInterest::Kind::kPrism;
  prism.p = 0.45;
  prism.polygon = {{0, 0}, {1, 0}, {0, 1}};
  prism.z = {0, 1};
  Task task;
  task.object = "cup-1";
  task.regions = {ellipsoid, prism};
  return task;
}

std::string field_of(const Task& task, int dims = 3) {
  const Status status = check_task(task, dims);
  return status ? "" : status.error().field;
}

TEST(CheckTask, TakesWhatCanBeLookedFor) {
  EXPECT_EQ(field_of(good()), "");
  EXPECT_EQ(field_of(good(), 2), "");
}

TEST(CheckTask, NamesWhatIsWrong) {
  const auto with = [](auto change) {
    Task task = good();
    change(task);
    return field_of(task);
  };
  EXPECT_EQ(with([](Task& t) { t.object = ""; }), "object");
  EXPECT_EQ(with([](Task& t) { t.extent = {1, kNaN, 1}; }), "extent");
  EXPECT_EQ(with([](Task& t) { t.regions.clear(); }), "regions");
  EXPECT_EQ(with([](Task& t) { t.regions.resize(kMaxRegions + 1); }), "regions");
  EXPECT_EQ(with([](Task& t) { t.regions[0].p = 0; }), "regions[0].p");
  EXPECT_EQ(with([](Task& t) { t.regions[0].center[2] = 1e300; }), "regions[0].center");
  EXPECT_EQ(with([](Task& t) { t.regions[0].radius = kNaN; }), "regions[0].radius");
  EXPECT_EQ(with([](Task& t) { t.regions[0].covariance[4] = -1; }), "regions[0].covariance");
  EXPECT_EQ(with([](Task& t) { t.regions[0].covariance[1] = 0.5; }), "regions[0].covariance");
  EXPECT_EQ(with([](Task& t) { t.regions[0].covariance[8] = kNaN; }), "regions[0].covariance");
  EXPECT_EQ(with([](Task& t) { t.regions[1].polygon.pop_back(); }), "regions[1].polygon");
  EXPECT_EQ(with([](Task& t) { t.regions[1].polygon[0][1] = kNaN; }), "regions[1].polygon");
  EXPECT_EQ(with([](Task& t) { t.regions[1].polygon.resize(2000); }), "regions");
  EXPECT_EQ(with([](Task& t) { t.regions[1].z = {1, 0}; }), "regions[1].z");
}

TEST(CheckTask, DoesNotLookAtHeightsInThePlane) {
  Task task = good();
  task.regions[0].center[2] = kNaN;
  task.regions[0].covariance[8] = 0;
  task.regions[1].z = {0, 0};
  EXPECT_EQ(field_of(task, 2), "");
  EXPECT_NE(field_of(task, 3), "");
}

}  // namespace
}  // namespace anchord
