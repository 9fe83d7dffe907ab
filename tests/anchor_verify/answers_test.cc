#include "answers.h"

#include <gtest/gtest.h>

#include <future>
#include <opencv2/imgproc.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/verification_codec.h"
#include "perception/camera_file.h"
#include "tasks.h"

namespace anchord {
namespace {

DetectorSettings plaza() {
  ConfigurationMistakes mistakes;
  const std::filesystem::path source(ANCHORD_SOURCE_DIR);
  return read_camera_file(source / "config/plaza.camera.json", mistakes).value();
}

/// The program's parts on a bus within the process.
class AnswersTest : public testing::Test {
 protected:
  AnswersTest() {
    EXPECT_TRUE(bus_->subscribe(kResultChannel, [this](std::span<const std::uint8_t> bytes) {
      results_.push_back(decode_result(bytes).value());
    }));
    EXPECT_TRUE(
        bus_->subscribe("END", [this](std::span<const std::uint8_t>) { end_.set_value(); }));
    bus_->start();
  }

  /// A picture of the plaza with or without a red ball where the tasks look.
  TimedPicture picture(bool with_ball, Utime utime) const {
    return picture(camera_, with_ball, utime);
  }
  TimedPicture picture(const Camera& camera, bool with_ball, Utime utime) const {
    cv::Mat frame(settings_.camera.height, settings_.camera.width, CV_8UC3,
                  cv::Scalar(120, 125, 130));
    if (with_ball) {
      const Eigen::Vector2d middle = camera.project({-10, -8, 0.3});
      const double radius = std::abs(middle.y() - camera.project({-10, -8, 0}).y());
      cv::circle(frame, {cvRound(middle.x()), cvRound(middle.y())}, cvRound(radius),
                 cv::Scalar(40, 30, 180), cv::FILLED);
    }
    return {{frame, {}}, utime};
  }

  /// All results that were published: messages of one bus come in order.
  const std::vector<VerificationResult>& results() {
    EXPECT_TRUE(bus_->publish("END", {}));
    EXPECT_EQ(end_.get_future().wait_for(std::chrono::seconds(10)), std::future_status::ready);
    return results_;
  }

  const DetectorSettings settings_ = plaza();
  const Camera camera_{settings_.camera};
  std::unique_ptr<LcmBus> bus_ = std::move(LcmBus::open("memq://").value());
  TaskList tasks_{"", "camera", 2, 2};
  Verifier verifier_{settings_, {}, 2};
  Answers answers_{"", "camera", tasks_, verifier_, *bus_};
  std::vector<VerificationResult> results_;
  std::promise<void> end_;
};

TEST_F(AnswersTest, TellsWhereItIs) {
  EXPECT_TRUE(tasks_.add(ball_task(1)));
  EXPECT_TRUE(answers_.look(picture(true, kNow)));
  ASSERT_EQ(results().size(), 1U);
  const VerificationResult& result = results_[0];
  EXPECT_EQ(result.task, 1);
  EXPECT_EQ(result.outcome, VerificationResult::Outcome::kFound);
  EXPECT_EQ(result.utime, kNow);
  ASSERT_TRUE(result.frame);
  EXPECT_EQ(result.frame->utime, kNow);
  EXPECT_EQ(result.frame->sensor, "camera");
  EXPECT_EQ(result.frame->view.value().type, View::Type::kNone);
  ASSERT_EQ(result.frame->detections.size(), 1U);
  EXPECT_EQ(result.frame->detections[0].object, "ball-1");
}

TEST_F(AnswersTest, OfACarriedCameraTheFrameHasThePose) {
  DetectorSettings carried = settings_;
  carried.camera.carried = true;
  carried.occluders.clear();
  Verifier verifier(carried, {}, 2);
  Answers answers("", "camera", tasks_, verifier, *bus_);
  Pose pose;  // 8 m before the ball, looking along x
  pose.position = {-18, -8, 1.5};
  pose.covariance[0] = 0.01;
  pose.covariance[35] = 0.001;
  TimedPicture seen = picture(camera_.at(pose), true, kNow);
  seen.picture.pose = pose;
  EXPECT_TRUE(tasks_.add(ball_task(1)));
  EXPECT_TRUE(answers.look(seen));
  ASSERT_EQ(results().size(), 1U);
  ASSERT_TRUE(results_[0].frame);
  EXPECT_EQ(results_[0].frame->pose, pose);
  const auto& measured =
      std::get<CartesianMeasurement>(results_[0].frame->detections.at(0).measurement);
  // Forward and left; the ball is drawn as a circle of whole pixels, 4 cm of ground each.
  EXPECT_NEAR(measured.position[0], 8, 0.1);
  EXPECT_NEAR(measured.position[1], 0, 0.05);
  // And not with the pose's own error, which across is 64 * 0.001 m^2.
  EXPECT_LT(measured.covariance[3], 0.01);
}

TEST_F(AnswersTest, FramesComeInOrderOfTime) {
  EXPECT_TRUE(tasks_.add(ball_task(1)));
  EXPECT_TRUE(tasks_.add(ball_task(2)));
  EXPECT_TRUE(answers_.look(picture(true, kNow)));
  ASSERT_EQ(results().size(), 2U);
  EXPECT_EQ(results_[0].frame->utime, kNow);
  EXPECT_EQ(results_[1].frame->utime, kNow + 1);
}

TEST_F(AnswersTest, MissingTakesLooksInARow) {
  EXPECT_TRUE(tasks_.add(ball_task(1)));
  EXPECT_TRUE(answers_.look(picture(false, kNow)));
  EXPECT_TRUE(answers_.look(picture(false, kNow + 100'000)));
  EXPECT_TRUE(answers_.look(picture(false, kNow + 200'000)));  // nobody asks any more
  ASSERT_EQ(results().size(), 1U);
  EXPECT_EQ(results_[0].outcome, VerificationResult::Outcome::kMissing);
  EXPECT_EQ(results_[0].utime, kNow + 100'000);
  EXPECT_FALSE(results_[0].frame);
  EXPECT_EQ(answers_.totals().looks, 2U);
}

}  // namespace
}  // namespace anchord
