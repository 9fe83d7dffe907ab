#include "perception/empty_scene.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

constexpr int kEdge = 40;
const cv::Scalar kPavement(120, 125, 130);

cv::Mat pavement() { return cv::Mat(kEdge, kEdge, CV_8UC3, kPavement); }

cv::Mat with_box(const cv::Rect& box, const cv::Scalar& color) {
  cv::Mat frame = pavement();
  frame(box).setTo(color);
  return frame;
}

const cv::Rect kBox(10, 10, 12, 20);
const cv::Point kInside(16, 20), kOutside(35, 5);

TEST(EmptyScene, ForgetsWhoPassesByWhileItLearns) {
  const cv::Mat passing = with_box(kBox, cv::Scalar(10, 10, 10));
  const EmptyScene scene({passing, pavement(), pavement(), passing, pavement()}, {});
  EXPECT_EQ(scene.foreground(pavement())(kInside), 0.0F);
}

TEST(EmptyScene, SeesWhatIsNew) {
  const EmptyScene scene({pavement()}, {});
  const cv::Mat1f foreground = scene.foreground(with_box(kBox, cv::Scalar(20, 20, 200)));
  EXPECT_EQ(foreground(kInside), 1.0F);
  EXPECT_EQ(foreground(kOutside), 0.0F);
}

TEST(EmptyScene, DoesNotMindShadows) {
  const EmptyScene scene({pavement()}, {});
  EXPECT_EQ(scene.foreground(with_box(kBox, kPavement * 0.8))(kInside), 0.0F);
  // Nobody's shadow is as dark as black cloth.
  EXPECT_EQ(scene.foreground(with_box(kBox, kPavement * 0.2))(kInside), 1.0F);
}

TEST(EmptyScene, TakesUpChangesButNotPeople) {
  const cv::Mat changed = with_box(kBox, cv::Scalar(60, 160, 90));
  cv::Mat1b occupied = cv::Mat1b::zeros(kEdge, kEdge);
  EmptyScene follows({pavement()}, {});
  EmptyScene keeps({pavement()}, {});
  for (int i = 0; i < 500; ++i) {  // 5 times the time constant of the default rate, 0.01
    follows.update(changed, occupied);
    keeps.update(changed, cv::Mat1b(kEdge, kEdge, uchar{255}));
  }
  EXPECT_EQ(follows.foreground(changed)(kInside), 0.0F);
  EXPECT_EQ(keeps.foreground(changed)(kInside), 1.0F);
}

}  // namespace
}  // namespace anchord
