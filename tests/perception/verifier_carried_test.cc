// The verifier with a camera that a robot carries.

#include <gtest/gtest.h>

#include "balls.h"
#include "geometry/conversion.h"
#include "perception/verifier.h"
#include "poses.h"

namespace anchord {
namespace {

using Sight = Sighting::Sight;

/// Half the pictures of kinect(), for time: 320 x 240, focal length 262.5 pixels.
DetectorSettings carried_kinect() {
  DetectorSettings settings = kinect();
  CameraParameters& c = settings.camera;
  c.carried = true;
  c.rotation = c.translation = Eigen::Vector3d::Zero();
  c.width = 320;
  c.height = 240;
  c.focal = 262.5;
  c.cx = 159.5;
  c.cy = 119.5;
  return settings;
}

class Carried : public testing::Test {
 protected:
  /// What the camera at the true pose sees of a ball, with the pose that is given.
  CameraPicture picture(const Pose& truth, const Pose& given, const Eigen::Vector3d& ball,
                        double radius = kBall[2] / 2, bool with_depth = true) const {
    CameraPicture result = empty(given);
    cv::Mat1f depth(result.frame.size(), 8.0F);
    draw_ball(camera_.at(truth), ball, radius, kRed, result.frame, &depth);
    if (with_depth) result.depth = depth;
    return result;
  }
  CameraPicture empty(const Pose& given) const {
    return {
        cv::Mat(settings_.camera.height, settings_.camera.width, CV_8UC3, kPavement), {}, given};
  }
  /// As the engine takes it from the frame of the result.
  static Gaussian in_map(const Sighting& sighting, const Pose& pose, int dims) {
    return to_map(std::get<CartesianMeasurement>(sighting.detection.value().measurement), pose,
                  dims)
        .value();
  }

  /// Balls about a place, looked at with poses as robots know theirs.
  void expect_honest(int dims) {
    Verifier verifier(settings_, {}, dims);
    // The pose's part of the covariance is by far the largest, so that the blob's, which is
    // generous (see expect_consistent()), does not decide.
    const Vector6d deviations = (Vector6d() << 0.1, 0.1, 0.03, 0.02, 0.02, 0.04).finished();
    const Pose truth = with_deviations(pose_of({0, 0, 1.2}, 0.5, 0.2, 0.05), deviations);
    const Eigen::Vector3d center = camera_.at(truth).at_depth({170, 110}, 3).position;
    const Eigen::Vector3d stands(center.x(), center.y(), dims == 2 ? 0 : center.z());
    Task task = ball_task(stands, 0.4);
    // Small: what a ball's near side is off by (see TwoPosesGiveOnePlace) shrinks with it.
    task.extent = {0.3, 0.3, 0.3};
    Draws draws;
    double sum = 0;
    int found = 0;
    constexpr int kLooks = 150;
    for (int i = 0; i < kLooks; ++i) {
      const Pose given = disturbed(truth, draws.random);
      const double r = draws.radius(settings_.verification) / 2;
      Eigen::Vector3d at = stands + 0.2 * Eigen::Vector3d(draws.normal(), draws.normal(), 0);
      CameraPicture seen = picture(truth, given, at + Eigen::Vector3d(0, 0, dims == 2 ? r : 0), r);
      draws.add_noise(seen.frame);
      const Sighting sighting = verifier.look(seen, task);
      if (sighting.sight != Sight::kFound) continue;
      ++found;
      const Gaussian there = in_map(sighting, given, dims);
      const Eigen::VectorXd error = (there.mean - at).head(dims);
      sum += error.dot(there.covariance.topLeftCorner(dims, dims).llt().solve(error));
    }
    EXPECT_GE(found, kLooks * 19 / 20);  // as in run_draws() of the camera that stands still
    // The 99.9 % interval of the mean; below, 15 % for the blob's part.
    const double slack = 3.3 * std::sqrt(2.0 * dims / found);
    EXPECT_LT(sum / found, dims + slack);
    EXPECT_GT(sum / found, 0.85 * dims - slack);
  }

  const DetectorSettings settings_ = carried_kinect();
  const Camera camera_{settings_.camera};
  Verifier verifier_{settings_, {}, 3};
  const Pose here_ = pose_of({0, 0, 1.2}, 0);
};

TEST_F(Carried, TwoPosesGiveOnePlace) {
  for (const int dims : {2, 3}) {
    Verifier verifier(settings_, {}, dims);
    const Eigen::Vector3d ball(3, 0.5, 0.3), stands(3, 0.5, dims == 2 ? 0 : 0.3);
    for (const Pose& pose : {pose_of({0, 0, 1.2}, 0.1, 0.2), pose_of({5, -2, 1.5}, 2.2, 0.3, 0.1),
                             pose_of({3, 3, 1}, -1.6, 0.15, -0.1)}) {
      const Sighting sighting = verifier.look(picture(pose, pose, ball), ball_task(stands, 0.3));
      ASSERT_EQ(sighting.sight, Sight::kFound) << sighting.reason;
      const Gaussian there = in_map(sighting, pose, dims);
      // By depth a ball comes out too far: its near side is 0.71 radii before its middle, not 0.85
      // (0.04 m), and its silhouette another r^2 / distance, 0.03 m. The rest is pixels.
      EXPECT_LT((there.mean - stands).norm(), 0.1) << dims;
      // In the sensor's frame, where x is forward: some metres before the camera.
      EXPECT_GT(position_of(sighting)[0], 2);
      EXPECT_EQ(sighting.detection->object, "ball-1");
    }
  }
}

TEST_F(Carried, HonestInSpace) { expect_honest(3); }
TEST_F(Carried, HonestOnTheGround) { expect_honest(2); }

TEST_F(Carried, IsFoundWhereThePosesErrorPutsIt) {
  const Eigen::Vector3d ball(3, 0, 1.2);
  Vector6d deviations = Vector6d::Zero(), error = Vector6d::Zero();
  deviations[1] = 0.4;
  error[1] = 0.8;
  const Pose exact = moved(here_, error), honest = with_deviations(exact, deviations);
  const Task task = ball_task(ball, 0.1);
  // The region is 0.28 m about the ball: 0.8 m beside it is another ball, if the pose is exact.
  EXPECT_EQ(verifier_.look(picture(here_, exact, ball), task).sight, Sight::kAbsent);
  const Sighting sighting = verifier_.look(picture(here_, honest, ball), task);
  ASSERT_EQ(sighting.sight, Sight::kFound);
  EXPECT_NEAR(in_map(sighting, honest, 3).mean.y(), 0.8, 0.05);
}

TEST_F(Carried, NothingInSightIsMissing) {
  const Sighting sighting = verifier_.look(empty(here_), ball_task({3, 0, 1.2}, 0.1));
  EXPECT_EQ(sighting.sight, Sight::kAbsent);
  EXPECT_GT(sighting.visible, 0.99);
  const Pose turned = pose_of({0, 0, 1.2}, 0.3);  // the picture is 1.1 rad wide
  EXPECT_EQ(verifier_.look(empty(turned), ball_task({3, 0, 1.2}, 0.1)).sight, Sight::kAbsent);
}

TEST_F(Carried, OutOfThePictureIsElsewhere) {
  for (const double yaw : {1.2, M_PI}) {
    const Sighting sighting =
        verifier_.look(empty(pose_of({0, 0, 1.2}, yaw)), ball_task({3, 0, 1.2}, 0.1));
    EXPECT_EQ(sighting.sight, Sight::kElsewhere) << yaw;
    EXPECT_EQ(sighting.looked_at, 0) << yaw;
  }
  // Half of it, at the edge of the picture; and all about the camera.
  const Task task = ball_task({3, 0, 1.2}, 0.1);
  EXPECT_EQ(verifier_.look(empty(pose_of({0, 0, 1.2}, 0.55)), task).sight, Sight::kElsewhere);
  EXPECT_EQ(verifier_.look(empty(here_), ball_task({0, 0, 1.2}, 0.5)).sight, Sight::kElsewhere);
}

TEST_F(Carried, AnUncertainPoseMakesNothingMissing) {
  // With its heading known to 0.5 rad half of what may be asked for is outside the picture.
  Vector6d deviations = Vector6d::Zero();
  deviations[5] = 0.5;
  const Pose lost = with_deviations(here_, deviations);
  const Sighting sighting = verifier_.look(empty(lost), ball_task({3, 0, 1.2}, 0.1));
  EXPECT_EQ(sighting.sight, Sight::kElsewhere);
  EXPECT_LT(sighting.visible, 0.8);
}

TEST_F(Carried, GroundThatTheTiltDoesNotTellIsNotSeen) {
  Verifier verifier(settings_, {}, 2);
  Vector6d deviations = Vector6d::Zero();
  deviations[4] = 0.1;  // at 5 m and 1.2 m high: (25 + 1.44) / 1.2 * 0.1 = 2.2 m
  const Pose nodding = with_deviations(here_, deviations);
  const Task task = ball_task({5, 0, 0}, 0.3);
  EXPECT_EQ(verifier.look(empty(here_), task).sight, Sight::kAbsent);
  EXPECT_EQ(verifier.look(empty(nodding), task).sight, Sight::kElsewhere);
  const Sighting sighting = verifier.look(picture(nodding, nodding, {5, 0, 0.3}), task);
  EXPECT_EQ(sighting.sight, Sight::kDoubtful);
  EXPECT_NE(sighting.reason.find("pose"), std::string::npos);
}

TEST_F(Carried, SomethingNearerHidesItOnceTheRobotIsThere) {
  CameraPicture seen = empty(here_);
  seen.depth = cv::Mat1f(seen.frame.size(), 1.5F);
  Task task = ball_task({3, 0, 1.2}, 0.1);
  EXPECT_EQ(verifier_.look(seen, task).sight, Sight::kHidden);
  task.viewpoint = pose_of({0.3, 0.2, 0}, 0);
  EXPECT_EQ(verifier_.look(seen, task).sight, Sight::kHidden);
  task.viewpoint = pose_of({3, 2, 0}, -1.6);
  EXPECT_EQ(verifier_.look(seen, task).sight, Sight::kElsewhere);
  seen.depth = cv::Mat1f();
  EXPECT_EQ(verifier_.look(seen, task).sight, Sight::kAbsent);  // in sight from here already
}

TEST_F(Carried, PeopleAreNotLookedFor) {
  Verifier verifier(settings_, {empty(here_).frame}, 2);
  Task task = ball_task({3, 0, 0}, 0.3);
  task.object_class = "person";
  const Sighting sighting = verifier.look(empty(here_), task);
  EXPECT_EQ(sighting.sight, Sight::kDoubtful);
  EXPECT_EQ(sighting.reason, "people are looked for by cameras that stand still");
}

}  // namespace
}  // namespace anchord
