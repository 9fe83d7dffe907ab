#include "perception/person_detector.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>

#include "geometry/view.h"
#include "plaza.h"

namespace anchord {
namespace {

const cv::Scalar kPavement(120, 125, 130), kRed(40, 30, 180);

class PersonDetectorTest : public testing::Test {
 protected:
  PersonDetectorTest()
      : camera_(settings_.camera),
        empty_(settings_.camera.height, settings_.camera.width, CV_8UC3, kPavement),
        detector_(settings_, {empty_}) {}

  cv::Mat with_person(double x, double y, const cv::Scalar& color) const {
    cv::Mat frame = empty_.clone();
    const auto person = stand(camera_, camera_.project({x, y, 0}), 1.74);
    const cv::Rect box = person->box() & cv::Rect(cv::Point(), frame.size());
    for (int row = box.y; row < box.br().y; ++row) {
      for (int column = box.x; column < box.br().x; ++column) {
        if (person->coverage(column, row) > 0.4) {
          frame.at<cv::Vec3b>(row, column) =
              cv::Vec3b(static_cast<uchar>(color[0]), static_cast<uchar>(color[1]),
                        static_cast<uchar>(color[2]));
        }
      }
    }
    return frame;
  }

  DetectorSettings settings_ = plaza_settings();
  Camera camera_;
  cv::Mat empty_;
  PersonDetector detector_;
};

TEST_F(PersonDetectorTest, PutsAPersonOnTheGround) {
  const auto people = detector_.detect(with_person(-10, -8, kRed));
  ASSERT_EQ(people.size(), 1U);
  const Eigen::Vector2d error = people[0].position - Eigen::Vector2d(-10, -8);
  // Within the region that holds 99 % of errors, if the covariance is honest.
  EXPECT_LT(error.dot(people[0].covariance.llt().solve(error)), 9.21);
  EXPECT_GT(people[0].score, 0);
  EXPECT_LT(people[0].score, 1);
}

TEST_F(PersonDetectorTest, IsLessSureOfPlacesFarAway) {
  const double near = detector_.detect(with_person(-14, -11, kRed))[0].covariance.trace();
  const double far = detector_.detect(with_person(2, -7, kRed))[0].covariance.trace();
  EXPECT_GT(far, 2 * near);  // the same body is half as tall in the picture
}

TEST_F(PersonDetectorTest, ReportsWhatTheEngineTakes) {
  const Frame frame =
      detector_.report(detector_.detect(with_person(-10, -8, kRed)), 1'700'000'000'000'000);
  EXPECT_EQ(frame.utime, 1'700'000'000'000'000);
  EXPECT_EQ(frame.sensor, "camera");
  EXPECT_FALSE(frame.pose);
  ASSERT_TRUE(frame.view);
  const auto view = MapView::place(*frame.view, frame.pose, 2);
  ASSERT_TRUE(view) << view.error().text();
  EXPECT_TRUE(view->contains({-10, -8, 0}));
  EXPECT_FALSE(view->contains({-30, -8, 0}));  // behind the camera's lower edge

  ASSERT_EQ(frame.detections.size(), 1U);
  const Detection& detection = frame.detections[0];
  const auto& measured = std::get<CartesianMeasurement>(detection.measurement);
  ASSERT_EQ(measured.position.size(), 2U);
  ASSERT_EQ(measured.covariance.size(), 4U);
  EXPECT_EQ(measured.covariance[1], measured.covariance[2]);
  const Eigen::Matrix2d covariance(Eigen::Map<const Eigen::Matrix2d>(measured.covariance.data()));
  EXPECT_EQ(covariance.llt().info(), Eigen::Success);
  ASSERT_EQ(detection.attributes.size(), 2U);
  EXPECT_EQ(detection.attributes[0].name, "class");
  EXPECT_EQ(detection.attributes[1].name, "color");
  const auto& colors = std::get<SymbolReport>(detection.attributes[1].value).probabilities;
  ASSERT_FALSE(colors.empty());
  EXPECT_EQ(colors[0].first, "red");
}

TEST_F(PersonDetectorTest, ReportsAnEmptyPlazaToo) {
  const Frame frame = detector_.report(detector_.detect(empty_), 1'700'000'000'000'000);
  EXPECT_TRUE(frame.detections.empty());
  EXPECT_TRUE(frame.view);
}

TEST_F(PersonDetectorTest, KeepsSeeingWhoStandsStill) {
  // Six time constants: the background would long have taken up what nobody keeps out of it.
  settings_.background.rate = 0.1;
  PersonDetector detector(settings_, {empty_});
  const cv::Mat frame = with_person(-10, -8, kRed);
  std::size_t seen = 0;
  for (int i = 0; i < 60; ++i) seen += detector.detect(frame).size();
  EXPECT_EQ(seen, 60U);
}

TEST_F(PersonDetectorTest, SamePicturesSamePeople) {
  PersonDetector other(settings_, {empty_});
  for (const double x : {-9.0, -9.5, -10.0}) {
    const cv::Mat frame = with_person(x, -8, kRed);
    EXPECT_EQ(detector_.report(detector_.detect(frame), 1), other.report(other.detect(frame), 1));
  }
}

}  // namespace
}  // namespace anchord
