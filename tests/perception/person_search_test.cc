#include "perception/person_search.h"

#include <gtest/gtest.h>

#include "plaza.h"

namespace anchord {
namespace {

class PersonSearchTest : public testing::Test {
 protected:
  PersonSearchTest()
      : camera_(settings_.camera),
        observable_(camera_.height(), camera_.width(), uchar{255}),
        foreground_(cv::Mat1f::zeros(camera_.height(), camera_.width())) {}

  /// Paints the body of a person who stands at a point of the map.
  void paint(double x, double y, double height_m = 1.74) {
    const auto person = stand(camera_, camera_.project({x, y, 0}), height_m);
    const cv::Rect box = person->box() & cv::Rect(cv::Point(), foreground_.size());
    for (int row = box.y; row < box.br().y; ++row) {
      for (int column = box.x; column < box.br().x; ++column) {
        if (person->coverage(column, row) > 0.4) foreground_(row, column) = 1;
      }
    }
  }
  std::vector<FoundPerson> find() const {
    return PersonSearch(camera_, observable_, settings_.search).find(foreground_);
  }
  /// Distance from a point of the map to the nearest found person.
  static double nearest(const std::vector<FoundPerson>& found, double x, double y) {
    double least = 1e9;
    for (const FoundPerson& each : found) {
      least = std::min(least, (each.silhouette.position - Eigen::Vector2d(x, y)).norm());
    }
    return least;
  }

  DetectorSettings settings_ = plaza_settings();
  Camera camera_;
  cv::Mat1b observable_;
  cv::Mat1f foreground_;
};

// The last step of the search is a pixel, some 0.05 m of ground here, and the painted outline is
// sharp where the model's is soft.
constexpr double kClose = 0.25;

TEST_F(PersonSearchTest, FindsNobodyOnAnEmptyPlaza) { EXPECT_TRUE(find().empty()); }

TEST_F(PersonSearchTest, FindsOnePersonWhereItStands) {
  paint(-10, -8);
  const auto found = find();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(nearest(found, -10, -8), kClose);
  EXPECT_NEAR(found[0].silhouette.height_m, 1.74, 0.1);  // a deviation and a half of people's
  EXPECT_GT(found[0].gain, 0.8);
  EXPECT_GT(found[0].filled, 0.8);
  EXPECT_NEAR(found[0].observed, 1, 1e-12);
  EXPECT_NEAR(found[0].alone, 1, 1e-12);
}

TEST_F(PersonSearchTest, TellsApartPeopleWhoOverlapInThePicture) {
  const auto near = stand(camera_, camera_.project({-12, -9, 0}), 1.74);
  // Beside and behind the first, who is 95 pixels tall and 30 wide.
  const Eigen::Vector2d offsets[] = {{22, 0}, {26, 0}, {22, -12}, {18, -25}, {14, -40}};
  for (const Eigen::Vector2d& offset : offsets) {
    SCOPED_TRACE(testing::Message() << offset.transpose());
    const auto far = stand(camera_, near->foot + offset, 1.74);
    foreground_ = 0.0F;
    paint(near->position.x(), near->position.y());
    paint(far->position.x(), far->position.y());
    const auto found = find();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_LT(nearest(found, near->position.x(), near->position.y()), kClose);
    EXPECT_LT(nearest(found, far->position.x(), far->position.y()), 2 * kClose);  // partly hidden
    if (offset.y() < 0) {  // else nobody stands before the other
      EXPECT_LT(std::min(found[0].alone, found[1].alone), 0.99);
    }
  }
}

TEST_F(PersonSearchTest, DoesNotCountWhatIsHiddenAgainstAPerson) {
  const auto person = stand(camera_, camera_.project({-10, -8, 0}), 1.74);
  paint(-10, -8);
  const cv::Rect box = person->box();
  const cv::Rect middle(box.x, box.y + box.height / 3, box.width, box.height / 3);
  foreground_(middle) = 0.0F;  // a sign stands before the person
  observable_(middle) = uchar{0};
  const auto found = find();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(nearest(found, -10, -8), kClose);
  EXPECT_LT(found[0].observed, 0.8);
  EXPECT_GT(found[0].filled, 0.8);
}

TEST_F(PersonSearchTest, IgnoresSpecks) {
  for (int i = 0; i < 200; ++i) foreground_(130 + 2 * i, 20 + 3 * i) = 1;
  EXPECT_TRUE(find().empty());
}

TEST_F(PersonSearchTest, GivesTheSameAnswerTwice) {
  for (const double x : {-8.0, -9.0, -10.0, -11.0}) paint(x, -7 + 0.5 * x);
  const auto first = find();
  const auto second = find();
  ASSERT_EQ(first.size(), second.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].silhouette.foot, second[i].silhouette.foot);
    EXPECT_EQ(first[i].gain, second[i].gain);
  }
}

}  // namespace
}  // namespace anchord
