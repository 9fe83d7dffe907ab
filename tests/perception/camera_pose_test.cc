#include "perception/camera_pose.h"

#include <gtest/gtest.h>

#include <limits>

#include "balls.h"
#include "geometry/conversion.h"
#include "poses.h"

namespace anchord {
namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
constexpr double kPixel = 1.5;   ///< standard deviation of the pixels that are drawn
constexpr double kDepth = 0.02;  ///< and of depths, m

/// A camera 1.2 m above the ground that looks down a little and is not level.
Pose tilted() { return pose_of({2, -1, 1.2}, 0.7, 0.25, 0.1); }

/// Standard deviations of a robot's localization; m, rad.
const Vector6d kLocalization = (Vector6d() << 0.05, 0.08, 0.02, 0.01, 0.012, 0.03).finished();

/// A point where the camera at the pose looks, on the plane of that height, or `depth` from it.
Eigen::Vector3d in_sight(const Camera& camera, double depth, double height, int dims) {
  if (dims == 3) return camera.at_depth({400, 250}, depth).position;
  Eigen::Vector3d result;
  result << camera.to_plane({400, 330}, height)->position, height;
  return result;
}

/// The position that a pixel and a depth (3-D) or the plane (2-D) give, and what the picture's
/// noise does to it.
Gaussian measured(const Camera& camera, const Eigen::Vector3d& pixel_depth, double height,
                  int dims) {
  Gaussian result;
  const double v = kPixel * kPixel;
  if (dims == 3) {
    const SpacePoint point = camera.at_depth(pixel_depth.head<2>(), pixel_depth.z());
    const Eigen::Vector3d noise(v, v, kDepth * kDepth);
    result.mean = point.position;
    result.covariance = point.jacobian * noise.asDiagonal() * point.jacobian.transpose();
  } else {
    const auto ground = camera.to_plane(pixel_depth.head<2>(), height);
    result.mean << ground->position, 0;
    result.covariance.topLeftCorner<2, 2>() = v * ground->jacobian * ground->jacobian.transpose();
  }
  return result;
}

CartesianMeasurement measurement(const Gaussian& position, int dims) {
  CartesianMeasurement result;
  for (int i = 0; i < dims; ++i) {
    result.position.push_back(position.mean[i]);
    for (int j = 0; j < dims; ++j) result.covariance.push_back(position.covariance(i, j));
  }
  return result;
}

constexpr int kDraws = 4000;

/// Mean NEES over draws of the pose's error, the pixel's and the depth's, of what the engine makes
/// of the measurement, divided by the dimensions. The truth stands still, as the camera does.
double mean_nees(const Pose& truth, int dims) {
  const Camera intrinsics(kinect().camera);
  const double height = 0.3;
  const Eigen::Vector3d point = in_sight(intrinsics.at(truth), 3, height, dims);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  double sum = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Pose given = disturbed(truth, random);
    Eigen::Vector3d seen;
    seen << intrinsics.at(truth).project(point), intrinsics.at(truth).depth(point);
    seen +=
        Eigen::Vector3d(kPixel * normal(random), kPixel * normal(random), kDepth * normal(random));
    const Gaussian in_sensor =
        in_sensor_frame(measured(intrinsics.at(given), seen, height, dims), height, given, dims);
    const Gaussian in_map = to_map(measurement(in_sensor, dims), given, dims).value();
    const Eigen::VectorXd error = (in_map.mean - point).head(dims);
    sum += error.dot(in_map.covariance.topLeftCorner(dims, dims).llt().solve(error));
  }
  return sum / kDraws / dims;
}

/// The 99.9 % interval of the mean of chi-squares over their dimensions, and 4 % for the second
/// order of height and tilt, whose deviation here is a tenth of the distance at most.
double slack(int dims) { return 3.3 * std::sqrt(2.0 / dims / kDraws) + 0.04; }

TEST(CameraPose, ErrorsInSpaceAreCountedOnce) {
  EXPECT_NEAR(mean_nees(with_deviations(tilted(), kLocalization), 3), 1, slack(3));
}

TEST(CameraPose, ErrorsOnTheGroundAreCountedOnce) {
  EXPECT_NEAR(mean_nees(with_deviations(tilted(), kLocalization), 2), 1, slack(2));
  // Height and tilt alone, which the engine's conversion leaves out in a 2-D world; and without.
  Vector6d part = kLocalization;
  for (const int i : {0, 1, 5}) part[i] = 1e-4;
  EXPECT_NEAR(mean_nees(with_deviations(tilted(), part), 2), 1, slack(2));
  part = kLocalization;
  for (const int i : {2, 3, 4}) part[i] = 1e-4;
  EXPECT_NEAR(mean_nees(with_deviations(tilted(), part), 2), 1, slack(2));
}

/// Heading 0.7: forward is (cos 0.7, sin 0.7). A camera that is too high sees the ground too far.
Matrix6d height_with_forward(double correlation) {
  Matrix6d covariance = kLocalization.cwiseAbs2().asDiagonal();
  const Eigen::Vector2d forward(std::cos(0.7), std::sin(0.7));
  covariance.topLeftCorner<2, 2>() = 0.05 * 0.05 * Eigen::Matrix2d::Identity();
  covariance.block<2, 1>(0, 2) = correlation * 0.05 * kLocalization[2] * forward;
  covariance.block<1, 2>(2, 0) = covariance.block<2, 1>(0, 2).transpose();
  return covariance;
}

TEST(CameraPose, ErrorsThatGoTogetherAreNotForgotten) {
  EXPECT_NEAR(mean_nees(with_covariance(tilted(), height_with_forward(0.9)), 2), 1, slack(2));
  // Errors that cancel: never surer than the truth, and at most what they would be without.
  const double cancelling = mean_nees(with_covariance(tilted(), height_with_forward(-0.9)), 2);
  EXPECT_LT(cancelling, 1 + slack(2));
  EXPECT_GT(cancelling, 0.5);
}

TEST(CameraPose, AnExactPoseAddsNothing) {
  const Camera camera = Camera(kinect().camera).at(tilted());
  for (const int dims : {2, 3}) {
    const Gaussian seen = measured(camera, {400, 330, 3}, 0.3, dims);
    const Gaussian there = in_sensor_frame(seen, 0.3, tilted(), dims);
    const Gaussian back = to_map(measurement(there, dims), tilted(), dims).value();
    EXPECT_LT((back.mean - seen.mean).norm(), 1e-12);  // rounding
    EXPECT_LT((back.covariance - seen.covariance).norm(), 1e-12);
  }
}

TEST(CameraPose, TheGroundIsKnownAsFarAsHeightAndTiltTell) {
  Vector6d deviations = Vector6d::Zero();
  deviations[4] = 0.02;
  const Pose pose = with_deviations(pose_of({0, 0, 1.2}, 0), deviations);
  // Deviation of the distance d: (d^2 + h^2) / h * 0.02; a fifth of it at d = 11.9.
  EXPECT_TRUE(ground_is_known({11, 0, 0}, pose));
  EXPECT_FALSE(ground_is_known({13, 0, 0}, pose));
  EXPECT_FALSE(ground_is_known({3, 0, 1.2}, pose));
  EXPECT_TRUE(ground_is_known({1000, 0, 0}, pose_of({0, 0, 1.2}, 0)));
}

TEST(CameraPose, PlacesAppearWhereThePosesErrorPutsThem) {
  const Pose pose = with_deviations(tilted(), kLocalization);
  const std::vector<Placement> places = {{{4, 1, 0}, 0.25}, {{5, 1, 0}, 0.75}};
  std::mt19937_64 random(3);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double weight = 0;
  for (const Placement& place : apparent_places({places[0]}, pose, 3)) {
    weight += place.weight;
    mean += place.weight * place.position;
  }
  mean /= weight;
  for (const Placement& place : apparent_places({places[0]}, pose, 3)) {
    moments +=
        place.weight / weight * (place.position - mean) * (place.position - mean).transpose();
  }
  EXPECT_NEAR(weight, 0.25, 1e-12);
  // Where the camera with the pose as given has what the true one has at the place.
  Eigen::Matrix3d drawn = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Pose truth = disturbed(pose, random);
    const Eigen::Vector3d in_camera = rotation_of(truth).transpose() *
                                      (places[0].position - Eigen::Vector3d(truth.position.data()));
    const Eigen::Vector3d apparent =
        Eigen::Vector3d(pose.position.data()) + rotation_of(pose) * in_camera;
    drawn += (apparent - places[0].position) * (apparent - places[0].position).transpose() / kDraws;
  }
  EXPECT_LT((mean - places[0].position).norm(), 1e-12);
  // Covariances of 4000 draws are exact within 1/sqrt(2000) of the largest; three times that.
  EXPECT_LT((moments - drawn).norm(), 0.07 * drawn.norm());
  // Places whose ground is not known do not count.
  EXPECT_EQ(apparent_places({{{300, 1, 0}, 1}}, pose, 2).size(), 0U);
  EXPECT_EQ(apparent_places(places, pose, 2).size(), 12U);
}

TEST(CameraPose, NamesWhatIsWrong) {
  const auto field = [](const Pose& pose) {
    const Status status = check_camera_pose(pose);
    return status ? std::string() : status.error().field;
  };
  const Pose good = with_deviations(tilted(), kLocalization);
  EXPECT_EQ(field(good), "");
  EXPECT_EQ(field(tilted()), "");
  for (const double bad : {kNever, 1e9, std::numeric_limits<double>::infinity()}) {
    Pose pose = good;
    pose.position[1] = bad;
    EXPECT_EQ(field(pose), "pose.position") << bad;
  }
  Pose pose = good;
  pose.orientation = {0, 0, 0, 0};
  EXPECT_EQ(field(pose), "pose.orientation");
  pose = good;
  pose.covariance[1] = pose.covariance[6] = 1;  // more than the variances allow
  EXPECT_EQ(field(pose), "pose.covariance");
  pose = good;
  pose.covariance[35] = 40;  // no direction at all
  EXPECT_EQ(field(pose), "pose.covariance");
  pose = good;
  pose.covariance[0] = 1e12;
  EXPECT_EQ(field(pose), "pose.covariance");
}

}  // namespace
}  // namespace anchord
