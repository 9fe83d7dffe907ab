#include <gtest/gtest.h>

#include "perception/verifier.h"
#include "plaza.h"
#include "sightings.h"

namespace anchord {
namespace {

using Sight = Sighting::Sight;

class VerifyPerson : public testing::Test {
 protected:
  VerifyPerson()
      : empty_(settings_.camera.height, settings_.camera.width, CV_8UC3, kPavement),
        verifier_(settings_, {empty_}, 2) {}

  void draw(double x, double y, const cv::Scalar& color, cv::Mat& frame) const {
    const auto person = stand(camera_, camera_.project({x, y, 0}), 1.74);
    const cv::Rect box = person->box() & cv::Rect(cv::Point(), frame.size());
    for (int row = box.y; row < box.br().y; ++row) {
      for (int column = box.x; column < box.br().x; ++column) {
        if (person->coverage(column, row) <= 0.4) continue;
        for (int i = 0; i < 3; ++i) {
          frame.at<cv::Vec3b>(row, column)[i] = static_cast<uchar>(color[i]);
        }
      }
    }
  }
  static Task task(double x, double y, double deviation) {
    Task task;
    task.object = "person-3";
    task.object_class = "person";
    task.regions = {ellipsoid({x, y, 0}, deviation, 2.45)};
    return task;
  }

  const DetectorSettings settings_ = plaza_settings();
  const Camera camera_{settings_.camera};
  const cv::Mat empty_;
  Verifier verifier_;
};

TEST_F(VerifyPerson, FindsHer) {
  cv::Mat frame = empty_.clone();
  draw(-10.2, -8.1, kRed, frame);
  const Sighting sighting = verifier_.look({frame, {}}, task(-10, -8, 0.3));
  ASSERT_EQ(sighting.sight, Sight::kFound);
  EXPECT_EQ(sighting.detection->object, "person-3");
  // Within the region that holds 99 % of errors, if the covariance is honest.
  EXPECT_LT(nees(sighting, Eigen::Vector2d(-10.2, -8.1)), 9.21);
  EXPECT_LT(sighting.looked_at, 0.06);
}

TEST_F(VerifyPerson, OfTwoTakesTheOneInTheRightClothes) {
  cv::Mat frame = empty_.clone();
  draw(-10, -9, kRed, frame);
  draw(-10, -7, kBlue, frame);
  Task who = task(-10, -8, 0.8);
  EXPECT_EQ(verifier_.look({frame, {}}, who).sight, Sight::kDoubtful);
  who.appearance = {{"color", SymbolReport{{{"blue", 0.95}}}}};
  const Sighting sighting = verifier_.look({frame, {}}, who);
  ASSERT_EQ(sighting.sight, Sight::kFound);
  EXPECT_LT(nees(sighting, Eigen::Vector2d(-10, -7)), 9.21);
}

TEST_F(VerifyPerson, IsAbsentFromAnEmptyPlace) {
  const Sighting sighting = verifier_.look({empty_, {}}, task(-10, -8, 0.3));
  EXPECT_EQ(sighting.sight, Sight::kAbsent);
}

TEST_F(VerifyPerson, MayBeBehindSomebody) {
  // Towards the camera from the region, and too near to be the one who is sought.
  const Eigen::Vector2d foot = camera_.project({-7, -5, 0});
  const auto nearer = camera_.to_ground(foot + Eigen::Vector2d(0, 35));
  cv::Mat frame = empty_.clone();
  draw(nearer->position.x(), nearer->position.y(), kBlue, frame);
  const Sighting sighting = verifier_.look({frame, {}}, task(-7, -5, 0.1));
  EXPECT_EQ(sighting.sight, Sight::kHidden);
}

TEST_F(VerifyPerson, MayBeBehindTheSign) {
  // The ground whose bodies come out in the middle of the sign of config/plaza.camera.json.
  const auto behind = camera_.to_plane({430, 223}, 0.87);
  const Sighting sighting =
      verifier_.look({empty_, {}}, task(behind->position.x(), behind->position.y(), 0.1));
  EXPECT_EQ(sighting.sight, Sight::kHidden);
}

TEST_F(VerifyPerson, NeedsToKnowTheEmptyScene) {
  Verifier verifier(settings_, {}, 2);
  EXPECT_EQ(verifier.look({empty_, {}}, task(-10, -8, 0.3)).sight, Sight::kDoubtful);
}

TEST_F(VerifyPerson, ReadsNothingOutsideTheRegion) {
  cv::Mat frame = empty_.clone();
  draw(-10, -8, kRed, frame);
  const cv::Rect box = verifier_.look({frame, {}}, task(-10, -8, 0.3)).box;
  expect_reads_only(box, frame, task(-10, -8, 0.3), verifier_, verifier_);
}

}  // namespace
}  // namespace anchord
