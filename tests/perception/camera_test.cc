#include "perception/camera.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "plaza.h"
#include "poses.h"

namespace anchord {
namespace {

Camera plaza_camera() { return Camera(plaza_settings().camera); }

struct CheckPoint {
  Eigen::Vector3d p_map;
  Eigen::Vector2d pixel;
};

// Computed with an independent program from the published calibration, to 1e-3 pixels.
const CheckPoint kCheckPoints[] = {{{0, 0, 0}, {351.872, 175.76}},
                                   {{5, -5, 0}, {574.071, 157.03}},
                                   {{-10, 3, 0}, {31.265, 245.349}},
                                   {{-5, -12, 0}, {691.516, 263.11}}};

TEST(Camera, ProjectsTheCheckPoints) {
  const Camera camera = plaza_camera();
  for (const CheckPoint& check : kCheckPoints) {
    EXPECT_LT((camera.project(check.p_map) - check.pixel).norm(), 1.5e-3);  // rounded to 1e-3
  }
}

TEST(Camera, PutsTheCheckPointsOnTheGround) {
  const Camera camera = plaza_camera();
  for (const CheckPoint& check : kCheckPoints) {
    const auto ground = camera.to_ground(check.pixel);
    ASSERT_TRUE(ground);
    // Pixels rounded to 1e-3, and at most 0.15 m of ground per pixel there.
    EXPECT_LT((ground->position - check.p_map.head<2>()).norm(), 3e-4);
  }
}

RC_GTEST_PROP(Camera, GroundAndPictureAreInverse, ()) {
  const Camera camera = plaza_camera();
  const Eigen::Vector2d pixel(*rc::gen::inRange(0, 768), *rc::gen::inRange(110, 576));
  const auto ground = camera.to_ground(pixel);
  RC_ASSERT(ground.has_value());
  const Eigen::Vector2d back = camera.project({ground->position.x(), ground->position.y(), 0});
  RC_ASSERT((back - pixel).norm() < 1e-9);  // rounding in numbers of some hundreds
}

RC_GTEST_PROP(Camera, JacobianIsTheDerivative, ()) {
  const Camera camera = plaza_camera();
  const Eigen::Vector2d pixel(*rc::gen::inRange(0, 768), *rc::gen::inRange(110, 576));
  const auto ground = camera.to_ground(pixel);
  const double h = 1e-3;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(axis);
    const Eigen::Vector2d slope =
        (camera.to_ground(pixel + step)->position - camera.to_ground(pixel - step)->position) /
        (2 * h);
    // Central differences: an error of h^2 times third derivatives, which are below 1e-3 here.
    RC_ASSERT((slope - ground->jacobian.col(axis)).norm() < 1e-8);
  }
}

RC_GTEST_PROP(Camera, DepthAndPlaneAreWhatProjectUndoes, ()) {
  const Camera camera = plaza_camera();
  const Eigen::Vector3d point(*rc::gen::inRange(-140, -40) * 0.1, *rc::gen::inRange(-100, 0) * 0.1,
                              *rc::gen::inRange(0, 30) * 0.1);
  const Eigen::Vector2d pixel = camera.project(point);
  // Newton's method in project() goes to rounding; coordinates are tens of metres.
  RC_ASSERT((camera.at_depth(pixel, camera.depth(point)).position - point).norm() < 1e-9);
  RC_ASSERT((camera.to_plane(pixel, point.z())->position - point.head<2>()).norm() < 1e-8);
  RC_ASSERT(
      (camera.part(100, 50, 60, 70).project(point) - (pixel - Eigen::Vector2d(100, 50))).norm() <
      1e-9);
}

RC_GTEST_PROP(Camera, JacobianInSpaceIsTheDerivative, ()) {
  const Camera camera = plaza_camera();
  const Eigen::Vector3d at(*rc::gen::inRange(0, 768), *rc::gen::inRange(0, 576),
                           *rc::gen::inRange(5, 40));
  const SpacePoint point = camera.at_depth(at.head<2>(), at.z());
  const double h = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d up = at + h * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d down = at - h * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d slope = (camera.at_depth(up.head<2>(), up.z()).position -
                                   camera.at_depth(down.head<2>(), down.z()).position) /
                                  (2 * h);
    // As above; and rounding of tens of metres over 2 h.
    RC_ASSERT((slope - point.jacobian.col(axis)).norm() < 1e-8);
  }
}

TEST(Camera, SeesNoGroundAboveTheHorizon) {
  // The camera looks down by some 16 degrees: its horizon lies above the picture.
  EXPECT_FALSE(plaza_camera().to_ground({384, -400}).has_value());
}

/// The pose that the plaza's calibration says: its optical axis is x, left y, up z.
Pose plaza_pose() {
  const CameraParameters c = plaza_settings().camera;
  const Eigen::Matrix3d camera_from_map =
      (Eigen::AngleAxisd(c.rotation.z(), Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(c.rotation.y(), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(c.rotation.x(), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  Eigen::Matrix3d map_from_sensor;
  map_from_sensor << camera_from_map.row(2).transpose(), -camera_from_map.row(0).transpose(),
      -camera_from_map.row(1).transpose();
  const Eigen::Quaterniond q(map_from_sensor);
  Pose pose = pose_of(-camera_from_map.transpose() * c.translation, 0);
  pose.orientation = {q.w(), q.x(), q.y(), q.z()};
  return pose;
}

RC_GTEST_PROP(Camera, CarriedThereIsTheCameraThatStandsThere, ()) {
  const Camera fixed = plaza_camera();
  CameraParameters parameters = plaza_settings().camera;
  parameters.carried = true;
  parameters.rotation = parameters.translation = Eigen::Vector3d::Zero();
  const Camera carried = Camera(parameters).at(plaza_pose());
  const Eigen::Vector3d at(*rc::gen::inRange(0, 768), *rc::gen::inRange(110, 576),
                           *rc::gen::inRange(5, 40));
  const SpacePoint a = fixed.at_depth(at.head<2>(), at.z());
  const SpacePoint b = carried.at_depth(at.head<2>(), at.z());
  // Rounding of tens of metres and hundreds of pixels.
  RC_ASSERT((a.position - b.position).norm() < 1e-10);
  RC_ASSERT((a.jacobian - b.jacobian).norm() < 1e-10);
  RC_ASSERT((fixed.project(a.position) - carried.project(a.position)).norm() < 1e-9);
  RC_ASSERT(std::abs(fixed.depth(a.position) - carried.depth(a.position)) < 1e-10);
  const auto ground = fixed.to_ground(at.head<2>()), same = carried.to_ground(at.head<2>());
  RC_ASSERT((ground->position - same->position).norm() < 1e-9);
  RC_ASSERT((ground->jacobian - same->jacobian).norm() < 1e-9);
}

TEST(Camera, CarriedLooksAlongX) {
  // At (1, 2, 3), looking along the map's y.
  const Camera camera = Camera(pinhole(640, 480, 525)).at(pose_of({1, 2, 3}, M_PI / 2));
  EXPECT_NEAR(camera.depth({1, 7, 3}), 5, 1e-12);
  const auto pixel = [&](double x, double y, double z) { return camera.project({x, y, z}); };
  EXPECT_LT((pixel(1, 7, 3) - Eigen::Vector2d(319.5, 239.5)).norm(), 1e-9);
  EXPECT_LT((pixel(0, 7, 3) - Eigen::Vector2d(319.5 - 105, 239.5)).norm(), 1e-9);  // left
  EXPECT_LT((pixel(1, 7, 4) - Eigen::Vector2d(319.5, 239.5 - 105)).norm(), 1e-9);  // up
}

TEST(Camera, SeesPeopleUpright) {
  const Camera camera = plaza_camera();
  const Eigen::Vector2d foot = camera.project({-10, -8, 0});
  const Eigen::Vector2d head = camera.project({-10, -8, 1.74});
  EXPECT_LT(head.y(), foot.y() - 60);  // people in this video are 60 to 150 pixels tall
  EXPECT_LT(std::abs(head.x() - foot.x()), 10);
}

}  // namespace
}  // namespace anchord
