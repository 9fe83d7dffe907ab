#include "perception/roi_mask.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "perception/placement.h"
#include "plaza.h"

namespace anchord {
namespace {

double uniform(double min, double max) {
  return min + (max - min) * *rc::gen::inRange(0, 1'000'001) * 1e-6;
}

Eigen::Vector3d direction(int dims) {
  const double angle = uniform(0, 2 * M_PI), z = dims == 3 ? uniform(-1, 1) : 0;
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// An ellipsoid on the plaza, of any shape and direction.
RegionOfInterest ellipsoid(int dims) {
  RegionOfInterest region;
  region.p = 0.95;
  region.center = {uniform(-14, -4), uniform(-10, 0), dims == 3 ? uniform(0, 2) : 0};
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i) = uniform(-0.8, 0.8);
  const Eigen::Matrix3d covariance = root * root.transpose() + 1e-4 * Eigen::Matrix3d::Identity();
  Eigen::Map<Eigen::Matrix3d>(region.covariance.data()) = covariance;
  region.radius = uniform(0.5, 3);
  return region;
}

/// A position in the region.
Eigen::Vector3d inside(const RegionOfInterest& region, int dims) {
  Eigen::Matrix3d covariance = Eigen::Map<const Eigen::Matrix3d>(region.covariance.data());
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  if (dims == 2) {
    const Eigen::Matrix2d flat = covariance.topLeftCorner<2, 2>();
    root.topLeftCorner<2, 2>() = Eigen::Matrix2d(flat.llt().matrixL());
  } else {
    root = covariance.llt().matrixL();
  }
  Eigen::Vector3d center(region.center.data());
  if (dims == 2) center.z() = 0;
  return center + root * direction(dims) * region.radius * uniform(0, 1);
}

/// Whether every point of a body at a position that is in the picture is in the mask.
void expect_covered(const Camera& camera, const RoiMask& roi, const Eigen::Vector3d& position,
                    const Body& body) {
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d side = direction(2) * body.radius * uniform(0, 1);
    const double z = uniform(-body.below, body.above);
    const Eigen::Vector2d pixel = camera.project(position + side + Eigen::Vector3d(0, 0, z));
    const cv::Point at(static_cast<int>(std::lround(pixel.x())),
                       static_cast<int>(std::lround(pixel.y())));
    if (!cv::Rect(0, 0, camera.width(), camera.height()).contains(at)) continue;
    RC_ASSERT(roi.box.contains(at));
    RC_ASSERT(roi.mask(at - roi.box.tl()) == 255);
  }
}

const std::array<double, 3> kPerson{0.7, 0.7, 1.9};

RC_GTEST_PROP(RoiMask, HoldsWhoeverStandsInAnEllipse, ()) {
  const Camera camera(plaza_settings().camera);
  const RegionOfInterest region = ellipsoid(2);
  const Body body = body_of(kPerson, 2);
  const RoiMask roi = roi_mask(camera, {region}, body, 2);
  for (int i = 0; i < 10; ++i) expect_covered(camera, roi, inside(region, 2), body);
}

RC_GTEST_PROP(RoiMask, HoldsWhateverIsInAnEllipsoid, ()) {
  const Camera camera(plaza_settings().camera);
  const RegionOfInterest region = ellipsoid(3);
  const Body body = body_of({0.3, 0.2, 0.4}, 3);
  const RoiMask roi = roi_mask(camera, {region}, body, 3);
  for (int i = 0; i < 10; ++i) expect_covered(camera, roi, inside(region, 3), body);
}

RC_GTEST_PROP(RoiMask, HoldsWhoeverStandsInAPrism, ()) {
  const Camera camera(plaza_settings().camera);
  const double x = uniform(-14, -8), y = uniform(-10, -4), a = uniform(0.1, 4), b = uniform(0.1, 4);
  RegionOfInterest region;
  region.kind = RegionOfInterest::Kind::kPrism;
  region.polygon = {{x, y}, {x + a, y}, {x + a, y + b}, {x, y + b}};
  const Body body = body_of(kPerson, 2);
  const RoiMask roi = roi_mask(camera, {region}, body, 2);
  for (int i = 0; i < 10; ++i) {
    expect_covered(camera, roi, {x + a * uniform(0, 1), y + b * uniform(0, 1), 0}, body);
  }
}

RegionOfInterest circle(double x, double y, double radius) {
  RegionOfInterest region;
  region.center = {x, y, 0};
  region.covariance = {1, 0, 0, 0, 1, 0, 0, 0, 0};
  region.radius = radius;
  return region;
}

TEST(RoiMask, IsSmallForASmallRegion) {
  const Camera camera(plaza_settings().camera);
  const RoiMask roi = roi_mask(camera, {circle(-10, -8, 0.3)}, body_of(kPerson, 2), 2);
  // A person there is about 100 pixels tall: 1.6 m x 1.9 m are some 92 x 110 of them.
  EXPECT_LT(roi.box.area(), 0.04 * camera.width() * camera.height());
  EXPECT_GT(roi.box.area(), 60 * 80);
}

TEST(RoiMask, JoinsRegions) {
  const Camera camera(plaza_settings().camera);
  const Body body = body_of(kPerson, 2);
  const auto a = circle(-10, -8, 0.3), b = circle(-6, -3, 0.3);
  const RoiMask both = roi_mask(camera, {a, b}, body, 2);
  EXPECT_EQ(both.box, roi_mask(camera, {a}, body, 2).box | roi_mask(camera, {b}, body, 2).box);
  EXPECT_LT(cv::countNonZero(both.mask), both.box.area());  // not what lies between them
}

TEST(RoiMask, IsEmptyBesideThePicture) {
  const Camera camera(plaza_settings().camera);
  EXPECT_TRUE(roi_mask(camera, {circle(-10, 20, 0.5)}, body_of(kPerson, 2), 2).box.empty());
}

TEST(RoiMask, IsThePictureWhereTheRegionReachesBehindTheCamera) {
  const Camera camera(plaza_settings().camera);
  const RoiMask roi = roi_mask(camera, {circle(-10, -8, 100)}, body_of(kPerson, 2), 2);
  EXPECT_EQ(roi.box, cv::Rect(0, 0, camera.width(), camera.height()));
}

TEST(RoiMask, IsEmptyBehindTheCamera) {
  const Camera camera(plaza_settings().camera);
  const Eigen::Vector3d eye = camera.at_depth({0, 0}, 0).position;
  const Eigen::Vector3d ahead = camera.at_depth({384, 288}, 1).position - eye;
  const Eigen::Vector2d behind = (eye - 20 * ahead).head<2>();
  const Body body = body_of(kPerson, 2);
  EXPECT_TRUE(roi_mask(camera, {circle(behind.x(), behind.y(), 0.5)}, body, 2).box.empty());
}

TEST(Placements, AreInTheRegionsAndSumToOne) {
  RegionOfInterest prism;
  prism.kind = RegionOfInterest::Kind::kPrism;
  prism.p = 0.2;
  prism.polygon = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  RegionOfInterest ellipse = circle(10, 10, 2);
  ellipse.p = 0.6;
  double all = 0, in_prism = 0;
  for (const Placement& place : placements({prism, ellipse}, 2)) {
    all += place.weight;
    const bool there = place.position.x() < 5;
    if (there) in_prism += place.weight;
    if (!there) {
      EXPECT_LE((place.position - Eigen::Vector3d(10, 10, 0)).norm(), 2);
    }
    EXPECT_EQ(place.position.z(), 0);
  }
  EXPECT_NEAR(all, 1, 1e-12);
  EXPECT_NEAR(in_prism, 0.25, 1e-12);  // as the regions' masses are
}

}  // namespace
}  // namespace anchord
