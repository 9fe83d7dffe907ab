#include "perception/verifier.h"

#include <gtest/gtest.h>

#include "balls.h"
#include "plaza.h"
#include "sightings.h"

namespace anchord {
namespace {

using Sight = Sighting::Sight;

TEST(Verifier, PlacesABallOnTheGround) {
  const DetectorSettings settings = plaza_settings();
  Verifier verifier(settings, {}, 2);
  const Camera camera(settings.camera);
  Draws draws;
  double sum = 0;
  int found = 0;
  for (int i = 0; i < 60; ++i) {
    const double r = draws.radius(settings.verification);
    const Eigen::Vector3d truth(-11 + 0.3 * draws.normal(), -8 + 0.3 * draws.normal(), 0);
    cv::Mat frame(settings.camera.height, settings.camera.width, CV_8UC3, kPavement);
    draw_ball(camera, truth + Eigen::Vector3d(0, 0, r), r, kRed, frame);
    draws.add_noise(frame);
    const Sighting sighting = verifier.look({frame, {}}, ball_task({-11, -8, 0}, 0.4));
    if (sighting.sight != Sight::kFound) continue;
    ++found;
    EXPECT_EQ(sighting.detection->object, "ball-1");
    EXPECT_EQ(position_of(sighting).size(), 2);
    sum += nees(sighting, truth);
  }
  EXPECT_GE(found, 58);  // the 95 % region and a size within 2.5 deviations leave few out
  expect_consistent(sum, found, 2);
}

class Kinect : public testing::Test {
 protected:
  cv::Mat empty() const {
    return {settings_.camera.height, settings_.camera.width, CV_8UC3, kPavement};
  }
  cv::Mat1f wall(float depth) const {
    return cv::Mat1f(settings_.camera.height, settings_.camera.width, depth);
  }
  void run_draws(bool with_depth) {
    Draws draws;
    double sum = 0;
    int found = 0;
    for (int i = 0; i < 60; ++i) {
      const double r = draws.radius(settings_.verification);
      const Eigen::Vector3d truth(3 + 0.3 * draws.normal(), 0.3 * draws.normal(),
                                  1.2 + 0.2 * draws.normal());
      cv::Mat frame = empty();
      cv::Mat1f depth = wall(8);
      draw_ball(camera_, truth, r, kRed, frame, &depth);
      draws.add_noise(frame);
      for (float& d : depth) {
        d += static_cast<float>(settings_.verification.depth_noise * d * d * draws.normal());
      }
      const Sighting sighting =
          verifier_.look({frame, with_depth ? depth : cv::Mat1f()}, ball_task({3, 0, 1.2}, 0.4));
      if (sighting.sight != Sight::kFound) continue;
      ++found;
      EXPECT_EQ(position_of(sighting).size(), 3);
      sum += nees(sighting, truth);
    }
    EXPECT_GE(found, 57);  // of 60: the ball may be larger than the class by 25 %
    expect_consistent(sum, found, 3);
  }

  const DetectorSettings settings_ = kinect();
  const Camera camera_{settings_.camera};
  Verifier verifier_{settings_, {}, 3};
};

TEST_F(Kinect, LooksAlongX) {
  EXPECT_NEAR(camera_.depth({3, 0, 1.2}), 3, 1e-9);
  EXPECT_LT(camera_.project({3, 1, 1.2}).x(), 319.5);  // left is left
  EXPECT_LT(camera_.project({3, 0, 2}).y(), 239.5);    // and up is up
}

TEST_F(Kinect, PlacesABallByItsDepth) { run_draws(true); }
TEST_F(Kinect, PlacesABallByItsSize) { run_draws(false); }

TEST_F(Kinect, SeesThatNothingIsThere) {
  const Sighting sighting = verifier_.look({empty(), wall(8)}, ball_task({3, 0, 1.2}, 0.2));
  EXPECT_EQ(sighting.sight, Sight::kAbsent);
  EXPECT_GT(sighting.visible, 0.99);
  // The region's near end is 2.4 m off: 2 x (0.56 m + the ball's 0.42) is 430 pixels there.
  EXPECT_LT(sighting.looked_at, 430.0 * 430 / (640 * 480));
}

TEST_F(Kinect, AnotherColorOrSizeIsNotIt) {
  cv::Mat frame = empty();
  draw_ball(camera_, {3, 0, 1.2}, 0.3, kBlue, frame);
  EXPECT_EQ(verifier_.look({frame, {}}, ball_task({3, 0, 1.2}, 0.2)).sight, Sight::kAbsent);
  EXPECT_EQ(verifier_.look({frame, {}}, ball_task({3, 0, 1.2}, 0.2, "blue")).sight, Sight::kFound);
  cv::Mat small = empty();
  cv::Mat1f depth = wall(8);
  draw_ball(camera_, {3, 0, 1.2}, 0.08, kRed, small, &depth);
  EXPECT_EQ(verifier_.look({small, depth}, ball_task({3, 0, 1.2}, 0.2)).sight, Sight::kAbsent);
}

TEST_F(Kinect, SomethingNearerHidesIt) {
  const Sighting sighting = verifier_.look({empty(), wall(1.5F)}, ball_task({3, 0, 1.2}, 0.2));
  EXPECT_EQ(sighting.sight, Sight::kHidden);
  EXPECT_LT(sighting.visible, 0.01);
}

TEST_F(Kinect, UnknownDepthSaysNothing) {
  EXPECT_EQ(verifier_.look({empty(), wall(0)}, ball_task({3, 0, 1.2}, 0.2)).sight, Sight::kHidden);
}

TEST_F(Kinect, TwoThatFitAreDoubtful) {
  cv::Mat frame = empty();
  draw_ball(camera_, {3, 0.45, 1.2}, 0.3, kRed, frame);
  draw_ball(camera_, {3, -0.45, 1.2}, 0.3, kRed, frame);
  EXPECT_EQ(verifier_.look({frame, {}}, ball_task({3, 0, 1.2}, 0.3)).sight, Sight::kDoubtful);
}

TEST_F(Kinect, AnOccluderOfTheCameraHides) {
  DetectorSettings settings = settings_;
  settings.occluders = {{{0, 0}, {640, 0}, {640, 480}, {0, 480}}};
  Verifier verifier(settings, {}, 3);
  cv::Mat frame = empty();
  draw_ball(camera_, {3, 0, 1.2}, 0.3, kRed, frame);
  EXPECT_EQ(verifier.look({frame, {}}, ball_task({3, 0, 1.2}, 0.2)).sight, Sight::kHidden);
}

TEST_F(Kinect, OutsideThePictureNothingIsSaid) {
  const Sighting sighting = verifier_.look({empty(), {}}, ball_task({3, 30, 1.2}, 0.2));
  EXPECT_EQ(sighting.sight, Sight::kHidden);
  EXPECT_EQ(sighting.looked_at, 0);
}

TEST_F(Kinect, TheCameraFileTellsWhatTheTaskDoesNot) {
  Task task = ball_task({3, 0, 1.2}, 0.2);
  task.extent = {};
  task.appearance = {};
  cv::Mat frame = empty();
  draw_ball(camera_, {3, 0, 1.2}, 0.3, kRed, frame);
  EXPECT_EQ(verifier_.look({frame, {}}, task).sight, Sight::kDoubtful);
  DetectorSettings settings = settings_;
  settings.verification.appearances["ball"] = {{"red"}, kBall};
  EXPECT_EQ(Verifier(settings, {}, 3).look({frame, {}}, task).sight, Sight::kFound);
}

TEST_F(Kinect, ReadsNothingOutsideTheRegion) {
  cv::Mat frame = empty();
  draw_ball(camera_, {3, 0, 1.2}, 0.3, kRed, frame);
  const Task task = ball_task({3, 0, 1.2}, 0.2);
  const cv::Rect box = roi_mask(camera_, task.regions, body_of(kBall, 3), 3).box;
  expect_reads_only(box, frame, task, verifier_, verifier_);
}

}  // namespace
}  // namespace anchord
